"""What `faience duplicates` does: look through the library page by page, and print each group at once."""

import json
from collections.abc import Callable, Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import typer
from rich.console import Console
from rich.table import Column, Table

from index.shapes import Status
from service.commands.opening import opened, settings_for
from service.commands.progress import progress_bar
from service.library import Library
from service.relations.duplicates import USUAL, Duplicates, Kind, find_duplicates
from service.relations.relation import Related, Relation


def show_duplicates(data_dir: Path, limit: int | None, re_posed: bool, as_json: bool) -> None:
    """Print the groups of duplicates of a library.

    Raises
    ------
    CommandFailed
        There is no library.
    """
    relations = (*USUAL, Relation.RE_POSED) if re_posed else USUAL
    with opened(settings_for(data_dir)) as library, progress_bar("Comparing", None) as advance:
        shown = 0
        for found in islice(_groups(library, relations, advance), limit):
            shown += 1
            if as_json:
                typer.echo(json.dumps(_fields(found)))
            else:
                Console().print(_table(found))
    if not shown and not as_json:
        typer.echo("There are no duplicates.")


def _groups(
    library: Library, relations: tuple[Kind, ...], advance: Callable[..., None]
) -> Iterator[Duplicates]:
    """Yield every group; tell how many shapes were looked at, of how many."""
    cursor: str | None = None
    looked, known = 0, library.catalogue.counts()[Status.READY]
    while True:
        page = find_duplicates(library, cursor=cursor, relations=relations)
        looked += page.looked
        advance(completed=looked, total=max(looked, known))
        yield from page.items
        cursor = page.next_cursor
        if cursor is None:
            return


def _fields(found: Duplicates) -> dict[str, Any]:
    group = found.group
    return {
        "id": group.id,
        "relation": group.relation,
        "shapes": [{"id": shape.id, "name": shape.name} for shape in found.shapes],
        "evidence": [
            {"one": one, "other": other, **_told(related)} for (one, other), related in group.pairs.items()
        ],
    }


def _told(related: Related) -> dict[str, Any]:
    evidence = related.evidence
    return {
        "relation": related.relation,
        "shape_distance": evidence.shape_distance,
        "colour_distance": evidence.colour_distance,
        "pattern_distance": evidence.pattern_distance,
        "pose_distance": evidence.pose_distance,
        "misfit": evidence.misfit,
    }


def _table(found: Duplicates) -> Table:
    title = f"{found.group.relation.replace('_', ' ')}, group {found.group.id}"
    columns = Column("name", overflow="fold"), Column("id", no_wrap=True, min_width=32)
    table = Table(*columns, title=title, title_justify="left")
    for shape in found.shapes:
        table.add_row(shape.name.replace("[", r"\["), shape.id)
    return table
