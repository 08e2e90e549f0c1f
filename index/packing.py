"""Packing: how the numbers of a block are kept, one byte each or in single precision.

What is kept is what is compared: a number counts as the one that its byte stands for, in a query as well.
"""

from dataclasses import dataclass

import numpy as np

from index.arrays import ByteArray, SingleArray

MIDDLE = 128  # byte of zero where numbers have a sign


@dataclass(frozen=True, kw_only=True)
class Packing:
    """Bytes that stand for whole numbers of units: c² for shares, c − 128 for numbers with a sign.

    A share x is kept as c = 255 √x: what is rare is told apart more finely than what is common. Both kinds
    are whole, so that sums of differences have no rounding, whatever their order.
    """

    squared: bool  # x = c² unit, else x = (c − 128) unit
    unit: float

    def pack(self, values: SingleArray) -> ByteArray:
        """Return the bytes of numbers; those beyond the range count as its ends."""
        exact = np.asarray(values, np.float64) / self.unit
        codes = np.sqrt(np.maximum(exact, 0.0)) if self.squared else exact + MIDDLE
        return np.rint(codes).clip(0, 255).astype(np.uint8)

    def unpack(self, codes: ByteArray) -> SingleArray:
        """Return the numbers that bytes stand for."""
        whole = np.asarray(codes, np.int64)
        levels = whole * whole if self.squared else whole - MIDDLE
        return np.asarray(levels * self.unit, np.float32)


_SHARES = Packing(squared=True, unit=1 / 255**2)
_CURVES = Packing(squared=False, unit=1 / 13)  # a whitened curve of 48 means stays within √(96 · 47/48) = 9.7
PACKINGS = {
    "log-hks": _SHARES,
    "colour-histogram": _SHARES,
    "colour-curves": _CURVES,
}  # others: single numbers


def rounded(name: str, values: SingleArray) -> SingleArray:
    """Return a block as it is compared."""
    packing = PACKINGS.get(name)
    return values if packing is None else packing.unpack(packing.pack(values))
