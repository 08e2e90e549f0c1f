"""`faience evaluate`: the paper's evaluation, on a folder of shapes and poses."""

from pathlib import Path
from typing import Annotated

import typer

from service.commands.failures import plain_failures
from service.commands.options import Json, Workers

Folder = Annotated[
    Path,
    typer.Argument(
        help="Holds posed/NAME/pose_XX.* (pose_00 is what must be found) and clutter/*.", metavar="DIR"
    ),
]
Out = Annotated[Path, typer.Option("--out", help="Where report.html, results.json and the cache go.")]
Methods = Annotated[
    list[str] | None, typer.Option("--method", help="Only this method; may be repeated.", metavar="METHOD")
]
Twins = Annotated[bool, typer.Option("--twins", help="Also: recoloured twins; damage and light at once.")]
Hard = Annotated[
    bool, typer.Option("--hard", help="All of that, and: 500 recoloured copies; 1 000 more shapes.")
]
Ablation = Annotated[bool, typer.Option("--ablation", help="Also measure `fused` without each of its parts.")]
OUT = Path("faience-evaluation")


def evaluate(
    folder: Folder,
    out: Out = OUT,
    methods: Methods = None,
    twins: Twins = False,
    hard: Hard = False,
    ablation: Ablation = False,
    workers: Workers = None,
    json: Json = False,
) -> None:
    """Measure every method by the protocol of Kovnatsky et al. (2011).

    Makes queries from each shape by bending, cutting, relighting and recolouring it at five strengths, and
    tells how well each method finds the shape again: tables, a JSON file and a page with pictures. What is
    described is kept, so that a stopped run goes on from there.
    """
    with plain_failures():
        from service.commands.evaluating import Plan, evaluate_folder  # heavy; --help must not wait for it

        plan = Plan(methods=tuple(methods or ()), twins=twins, hard=hard, ablation=ablation)
        evaluate_folder(folder, out, plan, workers, json)
