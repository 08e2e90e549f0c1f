"""`faience index`: bring files, folders and zips into the library."""

from pathlib import Path
from typing import Annotated

import typer

from service.commands.failures import plain_failures
from service.commands.options import DATA_DIR, Cluster, DataDir, Json, Workers

Paths = Annotated[list[Path], typer.Argument(help="Files (.ply, .obj, .zip) and folders of them.")]
AllowUntextured = Annotated[
    bool, typer.Option("--allow-untextured", help="Accept meshes whose material files or images are missing.")
]


def index(
    paths: Paths,
    data_dir: DataDir = DATA_DIR,
    workers: Workers = None,
    cluster: Cluster = None,
    allow_untextured: AllowUntextured = False,
    json: Json = False,
) -> None:
    """Index meshes. What is known already is skipped, so a stopped run can simply be repeated.

    An OBJ brings its MTL and images from the folder that was named. The exit code is 0 unless nothing
    could be read.
    """
    with plain_failures():
        from service.commands.indexing import index_paths  # heavy; --help must not wait for it
        from service.commands.opening import settings_for

        settings = settings_for(data_dir, workers=workers, cluster=cluster)
        index_paths(paths, settings, allow_untextured, json)
