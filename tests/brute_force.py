"""Searching by comparing with every shape: what the searcher is held against."""

from pathlib import Path

import numpy as np
import numpy.typing as npt

from index.methods import METHODS, Method
from index.packing import PACKINGS
from index.searcher import Searcher
from tests.catalogues import Opened, add_ready, open_catalogue

LENGTHS = {"log-hks": 6, "hks-0": 4, "hks-0.05": 4, "hks-0.1": 4, "colour-histogram": 30, "colour-curves": 9}
PLAIN = {"colour-histogram", "colour-curves"}
METHOD_NAMES = ["fused", "chks", "hks", "colour-histogram"]

Blocks = dict[str, npt.NDArray[np.float32]]
Ranked = list[tuple[str, float]]


def make_blocks(number: int) -> Blocks:
    """Return small multiples of 1/8, with few different values, so that distances tie."""
    generator = np.random.default_rng(number)
    return {
        name: generator.integers(0, 3, length).astype(np.float32) / np.float32(8)
        for name, length in LENGTHS.items()
    }


def add(opened: Opened, number: int) -> str:
    shape_id, blocks = f"s{number:04}", make_blocks(number % 17)
    plain = {name: block for name, block in blocks.items() if name in PLAIN}
    words = {name: block for name, block in blocks.items() if name not in PLAIN}
    add_ready(opened, shape_id, plain, words)
    return shape_id


def levels(name: str, block: npt.NDArray[np.float32]) -> npt.NDArray[np.int64]:
    """Return a block in whole units, as its bytes stand for them."""
    packing = PACKINGS[name]
    codes = packing.pack(block).astype(np.int64)
    return codes**2 if packing.squared else codes


def block_gap(name: str, one: Blocks, other: Blocks, packed: bool) -> tuple[float, float]:
    """Return the L1 distance of two blocks in units, and the unit."""
    if packed:
        return float(np.abs(levels(name, one[name]) - levels(name, other[name])).sum()), PACKINGS[name].unit
    return float(np.abs(one[name].astype(float) - other[name].astype(float)).sum()), 1.0


def distance(method: Method, one: Blocks, other: Blocks) -> float:
    """Compare two shapes as the service does: as bytes, where all of a method's blocks are packed."""
    packed = all(block.name in PACKINGS for block in method.blocks)
    total = 0.0
    for block in method.blocks:
        gap, unit = block_gap(block.name, one, other, packed)
        total += block.weight * unit**block.power * gap**block.power
    return total


def brute_force(opened: Opened, method: Method, query: Blocks, limit: int) -> Ranked:
    state = opened.catalogue.state()
    rows = opened.catalogue.block_rows(state.vocabulary_id)
    answer = sorted((distance(method, query, blocks), shape_id) for shape_id, blocks in rows)
    return [(shape_id, found) for found, shape_id in answer[:limit]]


def agrees(searcher: Searcher, opened: Opened, limit: int = 7) -> bool:
    query = make_blocks(99)
    return all(
        searcher.search(name, query, limit) == brute_force(opened, METHODS[name], query, limit)
        for name in METHOD_NAMES
    )


def add_in_process(folder: Path, numbers: list[int]) -> None:
    opened = open_catalogue(folder)
    for number in numbers:
        add(opened, number)
    opened.engine.dispose()
