"""`make soak`, or `python -m soak [PART …] [--scale 0.1]`: harm is done, and docs/promises.md filled."""

import secrets
import sys
import tempfile
import time
from pathlib import Path
from typing import Annotated

import typer

from soak.parts import PARTS, Order, Outcome
from soak.promises_page import keep

MESHES = Path(__file__).parents[2] / "shared" / "odd-meshes"
SHOWN = 20  # broken promises told of one part

Names = Annotated[list[str] | None, typer.Argument(help=f"Of: {', '.join(PARTS)}; all unless given.")]
Scale = Annotated[float, typer.Option(min=0.001, help="Less for a try, which leaves the page as it is.")]
Seed = Annotated[int | None, typer.Option(help="Of what is drawn; another one each time unless given.")]
Meshes = Annotated[Path, typer.Option(help="A folder of odd meshes to mutate, where there is one.")]


def soak(parts: Names = None, scale: Scale = 1, seed: Seed = None, meshes: Meshes = MESHES) -> None:
    """Break the service on purpose, part by part; exit 1 where a promise was broken."""
    seed = secrets.randbelow(2**31) if seed is None else seed
    broken = 0
    for name in parts or PARTS:
        typer.echo(f"{name} (seed {seed})")
        began = time.monotonic()
        outcome = _run(name, scale, seed, meshes if meshes.is_dir() else None)
        typer.echo(f"  {outcome.figures} [{time.monotonic() - began:.0f} s]")
        for promise in outcome.broken[:SHOWN]:
            typer.echo(f"  BROKEN: {promise}")
        broken += len(outcome.broken)
        if scale >= 1:
            keep(name, outcome.figures, len(outcome.broken), seed)
    raise typer.Exit(broken > 0)


def _run(name: str, scale: float, seed: int, meshes: Path | None) -> Outcome:
    if name not in PARTS:
        raise typer.BadParameter(f"{name} is none of {', '.join(PARTS)}")
    with tempfile.TemporaryDirectory(prefix="faience-soak-", ignore_cleanup_errors=True) as folder:
        order = Order(folder=Path(folder), seed=seed, scale=scale, meshes=meshes, report=_say)
        try:
            return PARTS[name](order)
        except (AssertionError, TimeoutError) as error:
            return Outcome(figures="ended early", broken=(str(error) or repr(error),))


def _say(line: str) -> None:
    typer.echo(f"  {line}", err=True, nl=not sys.stderr.isatty())
    if sys.stderr.isatty():
        typer.echo("\r", err=True, nl=False)


if __name__ == "__main__":
    typer.run(soak)
