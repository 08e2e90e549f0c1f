"""Draw docs/ranked-answers.png: sample creatures and what the default method finds. Run by `make picture`."""

import io
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

from benchmarks.describing import describe_files
from index.methods import DEFAULT_METHOD, METHODS
from index.vocabulary import default_vocabulary
from service.evaluation.cache import Described
from service.evaluation.measuring import as_compared, first_stage
from service.quantisation import quantise
from service.refining import LANDMARKS, QUERY_LADDER, QueryLandmarks, refine
from service.samples import make_samples
from worker.describe import Description

TARGET = Path(__file__).parents[1] / "docs" / "ranked-answers.png"
QUERIES = ("giraffe, grazing", "tiger cub, running", "octopus, reaching", "ember gecko, climbing")
ANSWERS = 6
TILE, GAP, CAPTION = 190, 26, 40  # pixels
INK, FAINT, PAPER = (38, 42, 52), (120, 126, 138), (255, 255, 255)


def main() -> None:
    """Describe the samples, rank them, draw."""
    samples = list(make_samples())
    with ProcessPoolExecutor(2, mp_context=get_context("forkserver")) as pool:
        described = list(pool.map(describe_files, [sample.files for sample in samples]))
    names = [sample.name for sample in samples]
    tiles = [Image.open(io.BytesIO(found.thumbnail)).resize((TILE, TILE)) for found in described]
    sheet = Image.new("RGB", ((ANSWERS + 1) * TILE + 2 * GAP, len(QUERIES) * (TILE + CAPTION) + GAP), PAPER)
    for row, query in enumerate(QUERIES):
        answers = _ranked(names.index(query), described)
        _draw_row(sheet, row, names.index(query), answers, names, tiles)
    TARGET.parent.mkdir(exist_ok=True)
    sheet.quantize(256).save(TARGET, optimize=True)
    print(f"{TARGET.name}: {TARGET.stat().st_size:,} bytes")


def _ranked(query: int, described: list[Description]) -> list[tuple[int, float]]:
    """Rank all but the query by the default method; which, and how far."""
    method, vocabulary = METHODS[DEFAULT_METHOD], default_vocabulary()
    shapes = [
        as_compared(Described(blocks={**found.blocks, **quantise(found.signatures, vocabulary)}))
        for found in described
    ]
    distances = first_stage(method, [shapes[query]], shapes)[0]
    found = sorted(
        ((f"{k:04d}", distance) for k, distance in enumerate(distances.tolist()) if k != query),
        key=lambda result: (result[1], result[0]),
    )
    landmarks = QueryLandmarks(
        packed=described[query].blocks[LANDMARKS], ladder=described[query].signatures[QUERY_LADDER]
    )
    stored = {f"{k:04d}": shape.blocks[LANDMARKS] for k, shape in enumerate(shapes)}
    ranked = refine(
        found, landmarks, {name: stored[name] for name, _ in found[: method.refined]}, method.refined
    )
    return [(int(name), distance) for name, distance in ranked[:ANSWERS]]


def _draw_row(
    sheet: Image.Image,
    row: int,
    query: int,
    answers: list[tuple[int, float]],
    names: list[str],
    tiles: list[Image.Image],
) -> None:
    """Draw a query on the left, a rule, and its answers by rank."""
    top = GAP // 2 + row * (TILE + CAPTION)
    draw = ImageDraw.Draw(sheet)
    draw.line([(TILE + GAP, top), (TILE + GAP, top + TILE + CAPTION // 2)], fill=FAINT)
    _draw_tile(sheet, GAP // 2, top, tiles[query], names[query], "query")
    for rank, (k, distance) in enumerate(answers, 1):
        left = int(GAP * 1.5) + rank * TILE
        _draw_tile(sheet, left, top, tiles[k], names[k], f"{rank}.  {distance:.3f}")


def _draw_tile(sheet: Image.Image, left: int, top: int, tile: Image.Image, name: str, note: str) -> None:
    sheet.paste(tile, (left, top), tile)
    draw = ImageDraw.Draw(sheet)
    middle = left + TILE // 2
    draw.text((middle, top + TILE), name, INK, ImageFont.load_default(14), anchor="ma")
    draw.text((middle, top + TILE + 17), note, FAINT, ImageFont.load_default(12), anchor="ma")


if __name__ == "__main__":
    main()
