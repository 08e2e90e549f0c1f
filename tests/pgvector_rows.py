"""Rows for the tests of pgvector: as many of each method as wanted, with ties, in a table and in memory."""

from dataclasses import dataclass
from itertools import count

import numpy as np
from sqlalchemy import Engine

from benchmarks.made_rows import Blocks, make_rows
from index.arrays import RowArray
from index.methods import METHODS
from index.pgvector.cursors import writing_cursor
from index.pgvector.form import Form
from index.pgvector.held import Held
from index.pgvector.table import Table
from index.shapes import CatalogueState
from index.vectors import Vectors

LENGTHS = {
    "log-hks": 128,
    "colour-histogram": 469,
    "hks-0": 48,
    "hks-0.05": 48,
    "hks-0.1": 48,
    "diffusion-geometric": 128,
    "diffusion-joint": 128,
    "meshhog": 48,
}
DESCRIBED = 12  # shapes of which rows are mixed
_NUMBERS = count(1)  # each table has a name of its own
STATE = CatalogueState(library="a", revision=1, epoch=1, vocabulary_id=None)


@dataclass(frozen=True, kw_only=True)
class Tabled:
    """The same rows twice."""

    held: Held  # of the table
    form: Form
    vectors: Vectors  # in memory
    queries: RowArray  # (q, width)


def described(repeated: int = 1) -> list[Blocks]:
    """Return blocks as long as real ones, or so many times as long: shares, and curves with a sign."""
    random = np.random.default_rng(7)
    shares = [
        {name: random.dirichlet(np.full(repeated * n, 0.3)).astype(np.float32) for name, n in LENGTHS.items()}
        for _ in range(DESCRIBED)
    ]
    return [{**each, "colour-curves": random.standard_normal(144).astype(np.float32)} for each in shares]


def tabled(engine: Engine, name: str, n_rows: int, *, graph: bool = False, repeated: int = 1) -> Tabled:
    """Put rows of a method, every fourth one twice, into a table and into memory."""
    made = make_rows(described(repeated), METHODS[name], n_rows, 4)
    made.rows[1::4] = made.rows[::4][: len(made.rows[1::4])]
    ids = [f"s{number:06}" for number in np.random.default_rng(1).permutation(n_rows)]
    vectors = Vectors(made.layout)
    vectors.put(ids, made.rows)
    vectors.settle()
    form, number = Form(made.layout), next(_NUMBERS)
    with writing_cursor(engine) as cursor:
        table = Table(cursor, form, number)
        table.create()
        table.append(ids, made.rows)
        table.add_key()
        if graph:
            table.add_graph()
    held = Held(
        state=STATE,
        form=form.name,
        lengths=made.layout.lengths,
        errors=table.errors,
        number=number,
        has_graph=graph,
    )
    return Tabled(held=held, form=form, vectors=vectors, queries=made.queries)
