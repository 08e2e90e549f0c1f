"""Layouts of made methods, and rows for them: bytes and single numbers."""

from collections.abc import Collection, Sequence
from fractions import Fraction
from itertools import pairwise

import numpy as np

from index.arrays import RowArray
from index.distances import levels_of
from index.layout import Layout
from index.methods import Block, Method

PACKED = ("log-hks", "colour-histogram", "colour-curves")  # squared, squared and plain bytes
WEIGHTS = (1 / 0.587, 1 / 1.83, 1 / 150.5)


def make_method(power: int, weights: Collection[float], names: Sequence[str] = ()) -> Method:
    names = names or [f"b{number}" for number in range(len(weights))]
    blocks = (
        Block(name=name, weight=weight, power=power) for name, weight in zip(names, weights, strict=False)
    )
    return Method(name="m", blocks=tuple(blocks), description="")


def single_layout(power: int, lengths: Sequence[int], weights: Sequence[float] = (1.7, 0.05, 0.3)) -> Layout:
    return Layout(method=make_method(power, weights[: len(lengths)]), lengths=tuple(lengths))


def byte_layout(power: int, lengths: Sequence[int], weights: Sequence[float] = WEIGHTS) -> Layout:
    return Layout(method=make_method(power, weights, PACKED[: len(lengths)]), lengths=tuple(lengths))


def random_rows(layout: Layout, n_rows: int, seed: int = 0) -> RowArray:
    generator = np.random.default_rng(seed)
    if layout.packings is None:
        return generator.normal(0, 100, (n_rows, layout.width)).astype(np.float32)
    return generator.integers(0, 256, (n_rows, layout.width), dtype=np.uint8)


def clustered_rows(layout: Layout, n_rows: int, n_clusters: int, seed: int = 0) -> RowArray:
    """Return rows that differ from few others by little, and by what moves many numbers together."""
    generator = np.random.default_rng(seed)
    middles = generator.uniform(40, 200, (n_clusters, layout.width))
    moves = generator.normal(0, 3, (6, layout.width))  # six directions
    rows = middles[generator.integers(0, n_clusters, n_rows)] + generator.normal(size=(n_rows, 6)) @ moves
    return np.rint(rows).clip(0, 255).astype(layout.dtype)


def exact_distance(layout: Layout, row: RowArray, query: RowArray, method: Method | None = None) -> Fraction:
    """Return the distance without any rounding but that of the blocks' weights."""
    gaps = exact_gaps(layout, row, query)
    weights = layout.weights(method or layout.method).tolist()
    sums = (sum(gaps[start:end], Fraction(0)) for start, end in pairwise(layout.edges.tolist()))
    parts = (Fraction(weight) * gap**layout.method.power for weight, gap in zip(weights, sums, strict=True))
    return sum(parts, Fraction(0))


def exact_gaps(layout: Layout, row: RowArray, query: RowArray) -> list[Fraction]:
    levels = levels_of(np.array([row, query]), layout).tolist()
    return [abs(Fraction(x) - Fraction(y)) for x, y in zip(*levels, strict=True)]
