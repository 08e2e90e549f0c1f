"""What `faience export` and `faience import` do: carry over with a progress bar, then say what came of it."""

import json
import time
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path

import typer

from service.backup.exporting import export_library
from service.backup.importing import import_library
from service.backup.summary import Damage, Summary
from service.commands.failures import STOPPED, CommandFailed
from service.commands.opening import opened, settings_for
from service.commands.progress import progress_bar

DAMAGED = 3  # exit code: it was done, but what was carried over is not whole
SHOWN = 20  # lines of a list; --json has all
MEGABYTE = 1_000_000


def export_to(file: Path, data_dir: Path, replace: bool, as_json: bool) -> None:
    """Export a library, and sum up.

    Raises
    ------
    CommandFailed
        The file exists, its folder does not, or something in the library is damaged.
    """
    if file.is_dir() or not file.parent.is_dir():
        raise CommandFailed(f"{file} must be a file in a folder that exists")
    if file.exists() and not replace:
        raise CommandFailed(f"{file} exists already; --replace replaces it")
    start = time.perf_counter()
    try:
        with opened(settings_for(data_dir)) as library, progress_bar("Exporting", None) as advance:
            summary = export_library(
                library, file, replace, lambda done, known: advance(completed=done, total=known)
            )
    except KeyboardInterrupt:
        raise CommandFailed("stopped; no file was written", STOPPED) from None
    _tell(f"Exported to {file}", summary, time.perf_counter() - start, as_json)


def import_from(file: Path, data_dir: Path, as_json: bool) -> None:
    """Import a library, and sum up.

    Raises
    ------
    CommandFailed
        There is no such file, or the library was damaged before it was exported.
    """
    if not file.is_file():
        raise CommandFailed(f"there is no file {file}")
    start = time.perf_counter()
    try:
        with opened(settings_for(data_dir), make=True) as library, progress_bar("Checking", None) as advance:

            def progress(what: str, done: int, known: int) -> None:
                advance(completed=done // MEGABYTE, total=known // MEGABYTE, title=f"{what} (MB)")

            summary = import_library(library, file, progress)
    except KeyboardInterrupt:
        raise CommandFailed("stopped; nothing was imported", STOPPED) from None
    _tell(f"Imported into {data_dir}", summary, time.perf_counter() - start, as_json)


def _tell(title: str, summary: Summary, seconds: float, as_json: bool) -> None:
    if as_json:
        typer.echo(json.dumps({**asdict(summary), "seconds": round(seconds, 3)}))
    else:
        size = f"{summary.files} files, {summary.bytes / MEGABYTE:.1f} MB"
        typer.echo(f"{title}: {summary.shapes} shapes ({size}) in {seconds:.1f} s.")
        _list("Left out, removed or sent anew meanwhile:", summary.left_out)
        _list("Damaged:", map(_line, summary.damaged))
    if summary.damaged:
        raise CommandFailed(f"{len(summary.damaged)} damages were found; all else was carried over", DAMAGED)


def _line(damage: Damage) -> str:
    whose = "" if damage.shape is None else f" of the shape {damage.shape}"
    return f"{damage.code}: {damage.what}{whose}"


def _list(title: str, lines: Iterable[str]) -> None:
    listed = list(lines)
    if listed:
        typer.echo(title)
    for line in listed[:SHOWN]:
        typer.echo(f"  {line}")
    if len(listed) > SHOWN:
        typer.echo(f"  … and {len(listed) - SHOWN} more; --json lists all.")
