"""`faience import`: a library from the file that `faience export` wrote."""

from pathlib import Path
from typing import Annotated

import typer

from service.commands.failures import plain_failures
from service.commands.options import DATA_DIR, DataDir, Json

File = Annotated[Path, typer.Argument(metavar="FILE", help="What `faience export` wrote.")]


def import_file(file: File, data_dir: DataDir = DATA_DIR, json: Json = False) -> None:
    """Make a library of an exported file, also one of an earlier version.

    The library must have no shapes yet. The file is checked as a whole first: all of it is imported, or
    nothing. The exit code is 0 when all is well, 3 when everything was imported but some of it was damaged
    before the export (it says what), and 1 when nothing was imported.
    """
    with plain_failures():
        from service.commands.backing_up import import_from  # heavy; --help must not wait for it

        import_from(file, data_dir, json)
