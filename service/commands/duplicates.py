"""`faience duplicates`: which shapes of the library are the same."""

from typing import Annotated

import typer

from service.commands.failures import plain_failures
from service.commands.options import DATA_DIR, DataDir, Json

Limit = Annotated[int | None, typer.Option("--limit", min=1, help="Groups at most.", show_default="all")]
RePosed = Annotated[bool, typer.Option("--re-posed", help="Also join shapes that differ in pose alone.")]


def duplicates(
    data_dir: DataDir = DATA_DIR, limit: Limit = None, re_posed: RePosed = False, json: Json = False
) -> None:
    """Show groups of shapes that are the same, but for their meshing or their colours. Nothing is removed."""
    with plain_failures():
        from service.commands.showing_duplicates import show_duplicates  # heavy; --help must not wait for it

        show_duplicates(data_dir, limit, re_posed, json)
