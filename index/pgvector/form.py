"""Form: how PostgreSQL keeps a row, and by how much that differs from the row.

A number of block b is kept as z = f_b (level − centre_b) with f_b = scale (w_b u_b^p)^(1/p), rounded. So the
L1 distance of two kept rows is scale · Σ_b (w_b u_b^p)^(1/p) S_b. For p = 1 that is scale times the distance
itself, but for the rounding. By how much rounding moves a row in each block is measured: see `errors`.
"""

import hashlib
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from index.arrays import DoubleArray, RowArray
from index.distances import levels_of
from index.layout import Layout
from index.packing import MIDDLE

VERSION = 1  # of this form: raise it when rows are kept in another way
PAGE_BYTES = 7_600  # of PostgreSQL's 8 192, for a vector; also what a graph takes at most, nearly
SLACK = 1e-12  # relative, of the double precision in which this is computed
_LARGEST_HALF, _LARGEST_SINGLE = 2.0**15, 1e30  # kept numbers; what is beyond counts as the end

KeptArray = npt.NDArray[np.floating]


@dataclass(frozen=True)
class Form:
    """Rows of bytes become numbers of 16 bits, others stay numbers of 32."""

    layout: Layout

    @property
    def halves(self) -> bool:
        """Whether numbers have 16 bits."""
        return self.layout.packings is not None

    @property
    def column(self) -> str:
        """The type of the vectors in SQL."""
        return f"{'halfvec' if self.halves else 'vector'}({self.layout.width})"

    @property
    def in_page(self) -> bool:
        """Whether a vector finds room in a page beside its id; a wider one lies apart."""
        return (2 if self.halves else 4) * self.layout.width <= PAGE_BYTES

    @property
    def name(self) -> str:
        """Tell this form from others: a table of another one is built anew."""
        method = self.layout.method
        told = (VERSION, method.blocks, self.layout.packings, self.layout.lengths)
        return hashlib.sha256(repr(told).encode()).hexdigest()

    @cached_property
    def worth(self) -> DoubleArray:
        """What a whole unit of each block counts before the power, (w u^p)^(1/p); (B,)."""
        method = self.layout.method
        return np.asarray(self.layout.weights(method) ** (1.0 / method.power))

    @cached_property
    def scale(self) -> float:
        """A power of two that brings bytes to where 16 bits are finest."""
        if not self.halves:
            return 1.0
        largest = np.where(self.layout.squared, 255.0**2, float(MIDDLE)) * self.worth
        return float(2.0 ** np.floor(np.log2(_LARGEST_HALF / largest.max())))

    def kept(self, rows: RowArray) -> KeptArray:
        """Return rows (m, width) as PostgreSQL keeps them."""
        most = _LARGEST_HALF if self.halves else _LARGEST_SINGLE
        numbers = self._numbers(rows).clip(-most, most)
        return numbers.astype(np.float16 if self.halves else np.float32)

    def errors(self, rows: RowArray, kept: KeptArray) -> DoubleArray:
        """Return by how much keeping moved each row in each block, at most; L1, kept units, (m, B)."""
        exact = self._numbers(rows)
        moved = np.abs(kept.astype(np.float64) - exact) + SLACK * np.abs(exact)
        return np.asarray(np.add.reduceat(moved, self.layout.edges[:-1], axis=1))

    def _numbers(self, rows: RowArray) -> DoubleArray:
        """Return rows before they are rounded, (m, width)."""
        layout = self.layout
        centres = np.where(layout.squared, 0.0, float(MIDDLE)) if self.halves else np.zeros(len(self.worth))
        factors = np.repeat(self.scale * self.worth, layout.lengths)
        return np.asarray((levels_of(rows, layout) - np.repeat(centres, layout.lengths)) * factors)
