"""Signed merges: few sums of a row's numbers that keep most of an L1 distance between near rows.

For a group g of numbers with signs σ, |Σ_g σ_i (x_i − y_i)| ≤ Σ_g |x_i − y_i|: sums over groups bound the
distance from below. What to merge is learnt from rows that are near each other, where bounds must be tight.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from index.arrays import DoubleArray, PositionArray, RowArray
from index.compiled import compiled
from index.distances import distances, levels_of
from index.layout import Layout

SAMPLE = 16_384  # rows among which near ones are looked for
ASKED = 64  # of them, whose nearest are taken
NEAREST = 16  # of each
SEED = 2011  # of the draws
ONE = 1 << 18  # a whole distance, where gaps are whole numbers: sums of 1 024 stay within 32 bits
ROUNDS = 3  # in which numbers may change their group
NONE = np.iinfo(np.int64).max

GapArray = npt.NDArray[np.int32]


@dataclass(frozen=True, kw_only=True, eq=False)
class Merges:
    """Groups of the numbers of a row, each of numbers of one block."""

    groups: PositionArray  # (width,), the group of each number
    signs: DoubleArray  # (width,), 1 or −1
    blocks: PositionArray  # (g,), the block of each group

    @property
    def count(self) -> int:
        """Number of groups."""
        return len(self.blocks)

    def ordered(self, order: PositionArray) -> "Merges":
        """Return the same groups in another order (g,)."""
        places = np.argsort(order)
        return Merges(groups=places[self.groups], signs=self.signs, blocks=self.blocks[order])


def learn_merges(rows: RowArray, layout: Layout, n_groups: int) -> Merges:
    """Put each number into the group, with the sign, to whose sums between near rows it adds most.

    Parameters
    ----------
    rows : (n, width) array
    layout : Layout
    n_groups : int
        At least one for each block.

    Returns
    -------
    Merges
    """
    blocks = np.repeat(np.arange(len(layout.lengths)), layout.lengths)
    gaps = _near_gaps(rows, layout)
    order = _by_share(gaps, layout)
    groups, signs = _assign(gaps, blocks, order, n_groups)
    return Merges(groups=groups, signs=signs.astype(np.float64), blocks=blocks[order[:n_groups]])


def merged(rows: RowArray, layout: Layout, merges: Merges) -> DoubleArray:
    """Return the sums over the groups, in whole units of each block; (m, groups)."""
    sums = np.zeros((len(rows), merges.count))
    _sums(rows, np.repeat(layout.squared, layout.lengths), merges.groups, merges.signs, sums)
    return sums


def _by_share(gaps: GapArray, layout: Layout) -> PositionArray:
    """Order numbers by their share in the distances, the greatest first, each block's first before all."""
    shares = np.abs(gaps).sum(axis=1, dtype=np.int64)
    for start, end in pairwise(layout.edges.tolist()):
        shares[start + np.argmax(shares[start:end])] += len(shares) * ONE * max(1, gaps.shape[1])
    return np.argsort(-shares, kind="stable")


def _near_gaps(rows: RowArray, layout: Layout) -> GapArray:
    """Return differences between near rows as shares of their distance; (width, pairs)."""
    random = np.random.default_rng(SEED)
    sample = rows[np.sort(random.choice(len(rows), min(SAMPLE, len(rows)), replace=False))]
    pairs = []
    for place in random.choice(len(sample), min(ASKED, len(sample)), replace=False):
        found = distances(sample, np.arange(len(sample)), sample[place], layout, layout.method)
        near = np.argsort(found, kind="stable")[: NEAREST + 1]
        pairs.append(levels_of(sample[near], layout) - levels_of(sample[place][None], layout))
    gaps = _in_distance(np.vstack(pairs).T, layout)
    total = np.abs(gaps).sum(axis=0)
    return np.asarray(np.rint(gaps[:, total > 0] / total[total > 0] * ONE), np.int32)


def _in_distance(gaps: DoubleArray, layout: Layout) -> DoubleArray:
    """Weigh each difference by what it adds to the distance: d grows by p w S^(p−1) a unit of it."""
    power, weights = layout.method.power, layout.weights(layout.method)
    sums = np.add.reduceat(np.abs(gaps), layout.edges[:-1], axis=0)  # (B, pairs)
    slopes = weights[:, None] * sums ** (power - 1)
    return np.asarray(gaps * np.repeat(slopes, layout.lengths, axis=0))


@compiled
def _sums(
    rows: RowArray,
    squared: npt.NDArray[np.bool_],
    groups: PositionArray,
    signs: DoubleArray,
    out: DoubleArray,
) -> None:
    for r in range(len(rows)):
        row, sums = rows[r], out[r]
        for i in range(len(row)):
            level = np.float64(row[i])
            sums[groups[i]] += signs[i] * (level * level if squared[i] else level)


@compiled
def _assign(
    gaps: GapArray, blocks: PositionArray, order: PositionArray, n_groups: int
) -> tuple[PositionArray, PositionArray]:
    """Return group and sign of each number; numbers come in an order, the first of them open the groups."""
    groups, signs = np.full(len(gaps), -1), np.ones(len(gaps), np.int64)
    sums = np.zeros((n_groups, gaps.shape[1]), np.int32)
    owner = np.empty(n_groups, np.int64)
    for g in range(n_groups):
        i = order[g]
        groups[i], owner[g], sums[g] = g, blocks[i], gaps[i]
    for _ in range(ROUNDS):
        for place in range(len(order)):
            i = order[place]
            if groups[i] >= 0:
                sums[groups[i]] -= np.int32(signs[i]) * gaps[i]
            groups[i], signs[i] = _best_group(gaps[i], sums, owner, blocks[i])
            sums[groups[i]] += np.int32(signs[i]) * gaps[i]
    return groups, signs


@compiled
def _best_group(gap: GapArray, sums: GapArray, owner: PositionArray, block: int) -> tuple[int, int]:
    """Return group and sign with which a number's gaps add most to the group's."""
    best, group, sign = -NONE, 0, 1
    for g in range(len(sums)):
        if owner[g] == block:
            plus, minus = _gains(gap, sums[g])
            if max(plus, minus) > best:
                best, group, sign = max(plus, minus), g, 1 if plus >= minus else -1
    return group, sign


@compiled
def _gains(gap: GapArray, group: GapArray) -> tuple[int, int]:
    """Return Σ |group + gap| − |group| and Σ |group − gap| − |group|."""
    plus, minus = np.int32(0), np.int32(0)
    for p in range(len(gap)):
        before = abs(group[p])
        plus = np.int32(plus + np.int32(abs(np.int32(group[p] + gap[p])) - before))
        minus = np.int32(minus + np.int32(abs(np.int32(group[p] - gap[p])) - before))
    return int(plus), int(minus)
