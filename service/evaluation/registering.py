"""The second stage of a method for many queries at once, in processes."""

from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Executor

from service.evaluation.cache import Described
from service.evaluation.protocol import Recipe
from service.refining import LANDMARKS, QUERY_LADDER, QueryLandmarks, additions_to
from worker.arrays import SingleArray

Additions = dict[tuple[Recipe, Recipe], float]  # of a query and a shape
TOGETHER = 20  # queries for one process


def additions_of(
    pool: Executor,
    wanted: Mapping[Recipe, tuple[Described, Sequence[Recipe]]],
    shapes: Mapping[Recipe, Described],
    known: Additions,
) -> None:
    """Register queries with shapes, but for the pairs that are known already; those become known.

    Parameters
    ----------
    pool : Executor
    wanted : mapping
        Query → its blocks and the shapes to register it with.
    shapes : mapping
        Shape → its blocks.
    known : dict
        What is found is put in.
    """
    tasks = []
    for query, (described, near) in wanted.items():
        new = {shape: shapes[shape].blocks[LANDMARKS] for shape in near if (query, shape) not in known}
        if new:
            tasks.append((query, _landmarks(described), new))
    groups = [tasks[start : start + TOGETHER] for start in range(0, len(tasks), TOGETHER)]
    for found in pool.map(_register, groups):
        known.update(found)


def _register(
    tasks: Iterable[tuple[Recipe, QueryLandmarks, Mapping[Recipe, SingleArray]]],
) -> Additions:
    return {
        (query, shape): added
        for query, landmarks, stored in tasks
        for shape, added in additions_to(landmarks, stored).items()
    }


def _landmarks(described: Described) -> QueryLandmarks:
    return QueryLandmarks(packed=described.blocks[LANDMARKS], ladder=described.blocks[QUERY_LADDER])
