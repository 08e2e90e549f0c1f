"""What a PLY body holds: columns of numbers, and lists of mixed lengths."""

from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.errors import Code, MeshError
from worker.reading.ply_header import Element


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


def check_counts(counts: IntArray, element: Element, before: int = 0) -> None:
    """Refuse lists of negative length.

    Parameters
    ----------
    counts : IntArray
        (n,) lengths in rows one after the other.
    element : Element
        Of which they are rows.
    before : int
        Rows before the first.

    Raises
    ------
    MeshError
        BAD_DATA
    """
    if (counts < 0).any():
        row = int(np.argmax(counts < 0))
        raise MeshError(
            Code.BAD_DATA,
            f"The {element.name} number {before + row + 1} announces a list of {int(counts[row])} numbers.",
        )


def truncated(element: Element, whole: int) -> MeshError:
    """Return the refusal of a file that ends after so many whole rows of an element."""
    return MeshError(
        Code.TRUNCATED,
        f"The file ends within its {element.name}s: {element.count:,} announced, {max(whole, 0):,} there.",
    )


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
