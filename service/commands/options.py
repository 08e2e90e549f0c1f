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
Cluster = Annotated[
    str | None,
    typer.Option(
        "--cluster",
        envvar="FAIENCE_CLUSTER",
        metavar="ADDRESS",
        help="Have meshes described by the Dask cluster of this scheduler, as in tcp://scheduler:8786. "
        "Files on this machine are sent along; the cluster itself says how many at a time.",
    ),
]
