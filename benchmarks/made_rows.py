"""Rows of made shapes, as many as wanted: objects mixed of described shapes, each in several states."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from index.arrays import RowArray, SingleArray
from index.layout import Layout
from index.methods import Method
from index.vocabulary import default_vocabulary
from service.quantisation import quantise
from service.samples import random_creatures
from worker.describe import describe
from worker.reading.upload import Upload

SEED = 2011
MIXED = 3  # described shapes in an object
STATES = 30  # of an object: poses, lights, damage, other versions
CHANGED = 0.25  # of a state that another shape gives, at most
NOISE = 0.05  # relative, of each number
PIECE = 50_000  # rows made at once

Blocks = Mapping[str, SingleArray]


@dataclass(frozen=True, kw_only=True)
class Made:
    """A library in rows."""

    layout: Layout
    rows: RowArray  # (n, width), states of one object anywhere
    queries: RowArray  # (q, width), other states of the same objects


def described_blocks(count: int) -> list[Blocks]:
    """Return all blocks of so many made shapes, in the words of the shipped vocabulary."""
    vocabulary = default_vocabulary()
    found: list[Blocks] = []
    for sample in random_creatures(count, SEED):
        description = describe(Upload(files=sample.files))
        found.append({**description.blocks, **quantise(description.signatures, vocabulary)})
    return found


def make_rows(described: Sequence[Blocks], method: Method, n_rows: int, n_queries: int) -> Made:
    """Make a library of n rows for a method, and queries."""
    layout = Layout.of(method, described[0])
    blocks = [np.stack([shape[block.name] for shape in described]) for block in method.blocks]
    random = np.random.default_rng(SEED)
    objects = _mixtures(blocks, -(-n_rows // STATES), random)
    order = random.permutation(n_rows) // STATES
    rows = np.empty((n_rows, layout.width), layout.dtype)
    for start in range(0, n_rows, PIECE):
        rows[start : start + PIECE] = _states(layout, blocks, objects, order[start : start + PIECE], random)
    queries = _states(layout, blocks, objects, random.integers(0, len(objects[0]), n_queries), random)
    return Made(layout=layout, rows=rows, queries=queries)


def _mixtures(blocks: Sequence[SingleArray], count: int, random: np.random.Generator) -> list[SingleArray]:
    """Mix described shapes by random shares; (count, length) of each block."""
    which = random.integers(0, len(blocks[0]), (count, MIXED))
    shares = random.dirichlet([0.5] * MIXED, count).astype(np.float32)
    return [np.einsum("nk,nkd->nd", shares, block[which]) for block in blocks]


def _states(
    layout: Layout,
    blocks: Sequence[SingleArray],
    objects: Sequence[SingleArray],
    which: "np.ndarray[tuple[int], np.dtype[np.int64]]",
    random: np.random.Generator,
) -> RowArray:
    """Change objects by a part of another shape, and noise; (m, width)."""
    other = random.integers(0, len(blocks[0]), len(which))
    share = random.uniform(0.0, CHANGED, (len(which), 1)).astype(np.float32)
    parts = []
    for number, (block, whole) in enumerate(zip(blocks, objects, strict=True)):
        state = (1.0 - share) * whole[which] + share * block[other]
        state *= np.exp(np.float32(NOISE) * random.standard_normal(state.shape, dtype=np.float32))
        if block.min() >= 0:  # shares of an area
            state /= np.maximum(state.sum(axis=1, keepdims=True), np.finfo(np.float32).tiny)
        parts.append(state if layout.packings is None else layout.packings[number].pack(state))
    return np.hstack(parts)
