"""Options that every command has."""

from pathlib import Path
from typing import Annotated

import typer

DATA_DIR = Path("faience-data")

DataDir = Annotated[
    Path,
    typer.Option(
        "--data-dir", envvar="FAIENCE_DATA_DIR", help="The folder that holds the library.", file_okay=True
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print JSON, one object a line, instead of tables.")]
Workers = Annotated[
    int | None, typer.Option("--workers", min=1, help="Meshes described at the same time.", show_default="2")
]
