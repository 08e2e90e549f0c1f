"""What a PLY body holds: columns of numbers, and lists of mixed lengths."""

from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.errors import Code, MeshError


@dataclass(frozen=True, kw_only=True, eq=False)
class Lists:
    """One list a row, end to end."""

    values: FloatArray  # (k,)
    counts: IntArray  # (n,), they sum to k


@dataclass(frozen=True, kw_only=True, eq=False)
class Table:
    """The rows of one element, by property."""

    scalars: dict[str, FloatArray]  # (n,) each; float64 holds every PLY type exactly
    lists: dict[str, Lists]


Body = dict[str, Table]  # by the element's name


def check_counts(counts: IntArray, what: str) -> None:
    """Refuse lists of negative length.

    Raises
    ------
    MeshError
        BAD_DATA
    """
    if (counts < 0).any():
        row = int(np.argmax(counts < 0))
        raise MeshError(Code.BAD_DATA, f"The {what} number {row + 1} announces {int(counts[row])} corners.")


def positions(starts: IntArray, counts: IntArray) -> IntArray:
    """Return start, start + 1, … of every list, end to end.

    Parameters
    ----------
    starts, counts : IntArray
        (n,)

    Returns
    -------
    IntArray
        (counts.sum(),)
    """
    before = np.cumsum(counts) - counts
    found: IntArray = np.repeat(starts - before, counts) + np.arange(int(counts.sum()))
    return found
