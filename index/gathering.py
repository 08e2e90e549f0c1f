"""Gathering: blocks as the catalogue yields them become long vectors, many at a time."""

from collections.abc import Iterable, Iterator
from itertools import islice

import numpy as np

from index.arrays import RowArray
from index.layout import Layout
from index.methods import Method
from index.stored_blocks import Blocks
from index.vectors import Vectors

_CHUNK = 1024  # vectors in one piece

Gathered = tuple[Layout, list[str], RowArray]  # the layout, m ids, their rows (m, width)


def gather(rows: Iterable[tuple[str, Blocks]], method: Method) -> Iterator[Gathered]:
    """Yield the vectors of the shapes that have all of a method's blocks, piece by piece.

    The first of them tells how long each block is; BadBlock where another disagrees.
    """
    names = {block.name for block in method.blocks}
    complete = ((shape_id, blocks) for shape_id, blocks in rows if names <= blocks.keys())
    layout: Layout | None = None
    while some := list(islice(complete, _CHUNK)):
        layout = layout or Layout.of(method, some[0][1])
        vectors = np.empty((len(some), layout.width), dtype=layout.dtype)
        for vector, (_, blocks) in zip(vectors, some, strict=True):
            layout.join(blocks, out=vector)
        yield layout, [shape_id for shape_id, _ in some], vectors


def put_all(pieces: Iterable[Gathered], vectors: Vectors | None = None) -> Vectors | None:
    """Return vectors with every piece in them, in order; None where there was neither."""
    for layout, ids, rows in pieces:
        if vectors is None:
            vectors = Vectors(layout)
        vectors.put(ids, rows)
    if vectors is not None:
        vectors.settle()
    return vectors
