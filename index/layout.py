"""Layout: where a method's blocks lie in one long vector, and how they are scaled there."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from index.arrays import DoubleArray, SingleArray
from index.errors import BadBlock
from index.methods import Method


@dataclass(frozen=True, kw_only=True)
class Layout:
    """The blocks of a method side by side.

    Scaled by c_b = (w_b / w_a)^(1/p), where a is the widest block, the L1 distance of two long vectors is
    s = Σ_b c_b ‖x_b − y_b‖₁, so that for B blocks

        p = 1:  d = w_a s          p = 2:  w_a s²/B ≤ d ≤ w_a s²    (Cauchy and Schwarz)

    The widest block has scale 1 and keeps every bit; the others are rounded by scaling.
    """

    method: Method  # all weights greater than 0
    lengths: tuple[int, ...]  # numbers in each of its blocks

    @classmethod
    def of(cls, method: Method, blocks: Mapping[str, SingleArray]) -> "Layout":
        """Return the layout that fits a shape's blocks."""
        return cls(method=method, lengths=tuple(blocks[block.name].size for block in method.blocks))

    @cached_property
    def width(self) -> int:
        """Numbers in the long vector."""
        return sum(self.lengths)

    @cached_property
    def slices(self) -> tuple[slice, ...]:
        """Where each block lies."""
        ends = np.cumsum(self.lengths)
        return tuple(
            slice(int(end) - length, int(end)) for end, length in zip(ends, self.lengths, strict=True)
        )

    @cached_property
    def widest(self) -> int:
        """Position of the block with scale 1."""
        return self.lengths.index(max(self.lengths))

    @cached_property
    def unit(self) -> float:
        """The widest block's weight w_a: what s counts in."""
        return self.method.blocks[self.widest].weight

    @cached_property
    def scales(self) -> SingleArray:
        """The c of every number, (width,)."""
        weights = np.array([block.weight for block in self.method.blocks])
        scales = (weights / self.unit) ** (1.0 / self.method.power)
        return np.repeat(scales, self.lengths).astype(np.float32)

    @cached_property
    def rounded(self) -> npt.NDArray[np.int64]:
        """Positions of the numbers that scaling may round, (r,)."""
        return np.flatnonzero(self.scales != 1.0)

    def join(self, blocks: Mapping[str, npt.ArrayLike], out: SingleArray | None = None) -> SingleArray:
        """Return blocks as one long vector (width,), not scaled; BadBlock where one is missing or wrong."""
        row = np.empty(self.width, dtype=np.float32) if out is None else out
        for block, place in zip(self.method.blocks, self.slices, strict=True):
            if block.name not in blocks:
                raise BadBlock(f"the method {self.method.name!r} needs the block {block.name!r}")
            values = np.asarray(blocks[block.name], dtype=np.float32)
            expected = place.stop - place.start
            if values.shape != (expected,) or not np.isfinite(values).all():
                raise BadBlock(f"block {block.name!r} must be {expected} finite numbers, not {values.shape}")
            row[place] = values
        return row

    def distances(self, rows: SingleArray, query: SingleArray, method: Method) -> DoubleArray:
        """Return Σ_b w_b ‖x_b − q_b‖₁^p of each row, in double precision.

        Parameters
        ----------
        rows : (m, width) float32
            Not scaled.
        query : (width,) float32
            Not scaled.
        method : Method
            Of this layout's blocks, perhaps with other weights.

        Returns
        -------
        (m,) float64
            Each row's number is the same, bit for bit, whatever rows stand beside it.
        """
        differences = np.abs(np.subtract(rows, query, dtype=np.float64))  # (m, width)
        total = np.zeros(len(rows))
        for block, place in zip(method.blocks, self.slices, strict=True):
            sums = differences[:, place].sum(axis=1)  # (m,)
            total += block.weight * (sums if block.power == 1 else sums * sums)
        return total
