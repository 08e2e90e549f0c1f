"""Layout: where a method's blocks lie in one row, and how their numbers are kept there."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from index.arrays import DoubleArray, RowArray
from index.errors import BadBlock
from index.methods import Method
from index.packing import PACKINGS, Packing


@dataclass(frozen=True, kw_only=True)
class Layout:
    """The blocks of a method side by side: bytes where all of them are packed, else single numbers."""

    method: Method
    lengths: tuple[int, ...]  # numbers in each of its blocks

    @classmethod
    def of(cls, method: Method, blocks: Mapping[str, npt.NDArray[np.float32]]) -> "Layout":
        """Return the layout that fits a shape's blocks."""
        return cls(method=method, lengths=tuple(blocks[block.name].size for block in method.blocks))

    @cached_property
    def width(self) -> int:
        """Numbers in a row."""
        return sum(self.lengths)

    @cached_property
    def edges(self) -> npt.NDArray[np.int64]:
        """Where the blocks begin, and the end of the last one, (B + 1,)."""
        return np.concatenate([[0], np.cumsum(self.lengths)])

    @cached_property
    def packings(self) -> tuple[Packing, ...] | None:
        """How each block's bytes are read; None where rows are single numbers."""
        found = [PACKINGS.get(block.name) for block in self.method.blocks]
        packed = tuple(packing for packing in found if packing is not None)
        return packed if len(packed) == len(found) else None

    @property
    def dtype(self) -> npt.DTypeLike:
        """Of the numbers in a row."""
        return np.float32 if self.packings is None else np.uint8

    @cached_property
    def squared(self) -> npt.NDArray[np.bool_]:
        """Whether the numbers of each block stand for their squares, (B,)."""
        packings = self.packings or ()
        return np.array([packing.squared for packing in packings] or [False] * len(self.lengths))

    @cached_property
    def units(self) -> DoubleArray:
        """What a difference of 1 between the numbers of a row, or their squares, stands for; (B,)."""
        packings = self.packings or ()
        return np.array([packing.unit for packing in packings] or [1.0] * len(self.lengths))

    def weights(self, method: Method) -> DoubleArray:
        """Return w u^p of each block, so that d = Σ_b (w u^p)_b S_b^p for sums S_b in whole units; (B,)."""
        weights = np.array([block.weight for block in method.blocks])
        return np.asarray(weights * self.units**method.power)

    def join(self, blocks: Mapping[str, npt.ArrayLike], out: RowArray | None = None) -> RowArray:
        """Return blocks as one row (width,); BadBlock where one is missing or wrong."""
        row = np.empty(self.width, dtype=self.dtype) if out is None else out
        places = zip(self.edges, self.edges[1:], strict=False)
        for number, (block, (start, end)) in enumerate(zip(self.method.blocks, places, strict=True)):
            if block.name not in blocks:
                raise BadBlock(f"the method {self.method.name!r} needs the block {block.name!r}")
            values = np.asarray(blocks[block.name], dtype=np.float32)
            expected = end - start
            if values.shape != (expected,) or not np.isfinite(values).all():
                raise BadBlock(f"block {block.name!r} must be {expected} finite numbers, not {values.shape}")
            row[start:end] = values if self.packings is None else self.packings[number].pack(values)
        return row
