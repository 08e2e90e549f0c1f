"""Opening: views in pgvector for a searcher."""

from collections.abc import Callable
from functools import partial

from sqlalchemy import Engine

from index.catalogue import Catalogue
from index.methods import Method
from index.pgvector.extension import prepare
from index.pgvector.index import PgvectorIndex


def views(catalogue: Catalogue, engine: Engine, *, graph: bool = False) -> Callable[[Method], PgvectorIndex]:
    """Return what makes a method's view; the database is looked at now.

    Parameters
    ----------
    graph : bool
        See `PgvectorIndex`.

    Raises
    ------
    NoPgvector
    """
    prepare(engine)
    return partial(PgvectorIndex, catalogue=catalogue, engine=engine, graph=graph)
