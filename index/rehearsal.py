"""A search in small: whatever is compiled on first use is, before somebody asks."""

import numpy as np

from index.layout import Layout
from index.methods import METHODS
from index.ranking import rank
from index.vectors import SKETCHED, Vectors

LENGTH = 20  # numbers in a block


def rehearse() -> None:
    """Order a few rows of bytes and of single numbers, and search them."""
    random = np.random.default_rng(0)
    for name in ("fused", "chks"):
        method = METHODS[name]
        layout = Layout(method=method, lengths=(LENGTH,) * len(method.blocks))
        vectors = Vectors(layout)
        rows = random.integers(0, 9, (SKETCHED, layout.width)).astype(layout.dtype)
        vectors.put([str(number) for number in range(SKETCHED)], rows)
        vectors.settle()
        rank(vectors, vectors.rows[0], 5)
