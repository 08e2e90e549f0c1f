"""`faience export`: a whole library as one file."""

from pathlib import Path
from typing import Annotated

import typer

from service.commands.failures import plain_failures
from service.commands.options import DATA_DIR, DataDir, Json

File = Annotated[Path, typer.Argument(metavar="FILE", help="Where to write it, such as library.tar.")]
Replace = Annotated[bool, typer.Option("--replace", help="Replace FILE if there is one.")]


def export(file: File, data_dir: DataDir = DATA_DIR, replace: Replace = False, json: Json = False) -> None:
    """Write the whole library into one file; the service may go on meanwhile.

    The file is a tar of everything but the API keys, with checksums; `faience import` makes a library of it.
    The exit code is 0 when all is well, 3 when FILE was written but something in the library is damaged (it
    says what), and 1 when no file was written.
    """
    with plain_failures():
        from service.commands.backing_up import export_to  # heavy; --help must not wait for it

        export_to(file, data_dir, replace, json)
