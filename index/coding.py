"""Coding: one byte for each merged group of a row's numbers."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from index.arrays import ByteArray, DoubleArray, RowArray
from index.distances import levels_of
from index.layout import Layout
from index.merging import Merges, learn_merges, merged

LEVELS = 256  # of a code
SPREAD = 0.4  # of the widest group's range that its codes cover; what is beyond counts as the end
OUTSIDE = 0.005  # share of rows at either side of that range
PIECE = 16_384  # rows coded at once
SLACK = 1e-6  # of a step, beside the rounding of sums


@dataclass(frozen=True, kw_only=True, eq=False)
class Coding:
    """How sums over groups become bytes: c stands for origin + step [c, c + 1), the ends for all beyond.

    Codes are added up and weighed together. So all groups of a block have one step; of a plain sum of
    distances (p = 1) all steps count the same.
    """

    layout: Layout
    merges: Merges  # with p = 2 block by block
    origins: DoubleArray  # (g,)
    steps: DoubleArray  # (g,)

    @classmethod
    def learn(cls, rows: RowArray, layout: Layout, n_groups: int) -> "Coding":
        """Learn merges into so many groups, and their ranges, from rows (n, width)."""
        merges = learn_merges(rows, layout, n_groups)
        sample = merged(rows[:: max(1, len(rows) // PIECE)], layout, merges)
        low, high = np.quantile(sample, [OUTSIDE, 1 - OUTSIDE], axis=0)
        worth = layout.weights(layout.method) ** (1.0 / layout.method.power)  # (B,)
        steps = _steps((high - low) * worth[merges.blocks], merges, layout) / worth[merges.blocks]
        order = np.arange(merges.count)
        if layout.method.power == 2:
            order = np.argsort(merges.blocks, kind="stable")
        origins = (low + high) / 2 - LEVELS / 2 * steps
        return cls(layout=layout, merges=merges.ordered(order), origins=origins[order], steps=steps[order])

    def arrays(self, name: str) -> dict[str, npt.NDArray[Any]]:
        """Return all that `restored` needs, under names of their own."""
        merges = self.merges
        parts = {"groups": merges.groups, "signs": merges.signs, "blocks": merges.blocks}
        parts |= {"origins": self.origins, "steps": self.steps}
        return {f"{name}-{part}": array for part, array in parts.items()}

    @classmethod
    def restored(cls, layout: Layout, arrays: Mapping[str, npt.NDArray[Any]], name: str) -> "Coding":
        """Return the coding that gave these arrays under a name."""
        merges = Merges(**{part: arrays[f"{name}-{part}"] for part in ("groups", "signs", "blocks")})
        origins, steps = arrays[f"{name}-origins"], arrays[f"{name}-steps"]
        return cls(layout=layout, merges=merges, origins=origins, steps=steps)

    def places(self, rows: RowArray) -> DoubleArray:
        """Return where rows lie in steps from the origins, (m, g)."""
        return (merged(rows, self.layout, self.merges) - self.origins) / self.steps

    def codes(self, rows: RowArray) -> ByteArray:
        """Return the codes of rows, (m, g)."""
        codes = np.empty((len(rows), self.merges.count), np.uint8)
        for start in range(0, len(rows), PIECE):
            places = self.places(rows[start : start + PIECE])
            codes[start : start + PIECE] = np.floor(places).clip(0, LEVELS - 1)
        return codes

    @property
    def counts(self) -> DoubleArray:
        """What a step of each group counts in the method's own distance, relative to the most; (g,)."""
        method = self.layout.method
        worth = self.layout.weights(method) ** (1.0 / method.power)
        counts = self.steps * worth[self.merges.blocks]
        return np.asarray(counts / counts.max())

    def ends(self, query: RowArray, largest: float) -> tuple[ByteArray, ByteArray]:
        """Return below and above, (g,) each: a row of code c is at least c − above and below − c steps away.

        Parameters
        ----------
        query : (width,) array
        largest : float
            L1 norm of the largest row in whole units: sums are rounded in proportion to what is added.
        """
        place = self.places(query[None])[0]
        norm = largest + float(np.abs(levels_of(query[None], self.layout)).sum())
        slack = SLACK + 4 * np.finfo(float).eps * self.layout.width * norm / self.steps
        above = np.ceil(place + slack).clip(0, LEVELS - 1)
        below = (np.floor(place - slack) - 1).clip(0, LEVELS - 1)
        return below.astype(np.uint8), above.astype(np.uint8)


def _steps(ranges: DoubleArray, merges: Merges, layout: Layout) -> DoubleArray:
    """Return what a step of each group counts, from the ranges of the groups in the distance; (g,)."""
    widest = np.full(len(layout.lengths), ranges.max())
    if layout.method.power == 2:
        widest = np.array([ranges[merges.blocks == block].max() for block in range(len(layout.lengths))])
    return np.where(widest > 0, widest * SPREAD / LEVELS, 1.0)[merges.blocks]
