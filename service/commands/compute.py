"""`faience compute`: describe meshes for a Dask cluster."""

import os
from typing import Annotated

import typer

from service.commands.failures import plain_failures
from service.commands.options import Json
from service.commands.reporting import reporter

Address = Annotated[
    str,
    typer.Option(
        "--cluster",
        envvar="FAIENCE_CLUSTER",
        metavar="ADDRESS",
        help="The scheduler, as in tcp://scheduler:8786; `dask scheduler` is one.",
    ),
]
Workers = Annotated[
    int | None,
    typer.Option("--workers", min=1, help="Meshes described at the same time.", show_default="all cores"),
]


def compute(cluster: Address, workers: Workers = None, json: Json = False) -> None:
    """Describe meshes for the workers of a cluster (`faience worker --cluster`) until stopped.

    It needs no library: what a mesh may use is said by who asks. Others take over what is unfinished.
    """
    with plain_failures():
        from service.commands.computing import compute_for  # heavy; --help must not wait for it

        compute_for(cluster, workers or os.cpu_count() or 1, reporter(json))
    raise typer.Exit(0)
