"""`faience search`: what in the library is similar to a file."""

from pathlib import Path
from typing import Annotated

import typer

from service.commands.failures import plain_failures
from service.commands.options import DATA_DIR, DataDir, Json

Files = Annotated[list[Path], typer.Argument(metavar="FILE…", help="Meshes (.ply, .obj or .zip).")]
Method = Annotated[str | None, typer.Option("--method", help="How to compare.", show_default="fused")]
Limit = Annotated[int, typer.Option("--limit", min=1, help="Results for each file, at most.")]
AllowUntextured = Annotated[
    bool, typer.Option("--allow-untextured", help="Accept meshes whose material files or images are missing.")
]


def search(
    files: Files,
    data_dir: DataDir = DATA_DIR,
    method: Method = None,
    limit: Limit = 10,
    allow_untextured: AllowUntextured = False,
    json: Json = False,
) -> None:
    """Rank the library by similarity to each file. The files themselves are not kept."""
    with plain_failures():
        from service.asking import Question
        from service.commands.searching import search_files  # heavy; --help must not wait for it

        question = Question(limit=limit) if method is None else Question(method=method, limit=limit)
        search_files(files, data_dir, question, allow_untextured, json)
