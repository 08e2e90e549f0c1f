"""What a multifrontal factorisation needs to know of a pattern, before any number."""

from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.compiled import compiled
from worker.geometry.dissection import dissect


@dataclass(frozen=True, kw_only=True, eq=False)
class Fronts:
    """Dense blocks of a sparse triangular factor: a front for each group that is eliminated at once.

    Duff and Reid (1983), "The multifrontal solution of indefinite sparse symmetric linear equations". Front k
    eliminates the places groups[k]:groups[k + 1] of the order; besides them it has the rows
    rows[begins[k]:begins[k + 1]], later places that the factor couples them to.
    """

    order: IntArray  # (n,), the vertex at each place
    places: IntArray  # (n,), the place of each vertex
    groups: IntArray  # (g + 1,)
    begins: IntArray  # (g + 1,)
    rows: IntArray  # places, ascending in each front
    parents: IntArray  # (g,), the front that a front's remainder is added to; −1 for none


def find_fronts(points: FloatArray, starts: IntArray, neighbours: IntArray) -> Fronts:
    """Choose an order and find the fronts; arguments as for `dissect`."""
    order, groups = dissect(points, starts, neighbours)
    places, begins, rows, parents = _rows(order, groups, starts, neighbours)
    sequence = _postorder(parents)
    if np.any(np.diff(sequence) < 0):
        widths = np.diff(groups)[sequence]
        order = order[
            np.repeat(groups[sequence] - np.cumsum(widths) + widths, widths) + np.arange(len(order))
        ]
        groups = np.concatenate([[0], np.cumsum(widths)])
        places, begins, rows, parents = _rows(order, groups, starts, neighbours)
    return Fronts(order=order, places=places, groups=groups, begins=begins, rows=rows, parents=parents)


@compiled
def _rows(
    order: IntArray, groups: IntArray, starts: IntArray, neighbours: IntArray
) -> tuple[IntArray, IntArray, IntArray, IntArray]:
    """Return places, begins, rows and parents: a front takes what its own are coupled to."""
    n, n_groups = len(order), len(groups) - 1
    places = np.empty(n, np.int64)
    places[order] = np.arange(n)
    group_of = np.repeat(np.arange(n_groups), np.diff(groups))
    begins, parents = np.zeros(n_groups + 1, np.int64), np.full(n_groups, -1)
    first_child, sibling = np.full(n_groups, -1), np.full(n_groups, -1)
    seen, rows = np.full(n, -1), np.empty(8 * n + 8, np.int64)
    for group in range(n_groups):
        end, n_rows = groups[group + 1], begins[group]
        if n_rows + n > len(rows):
            longer = np.empty(2 * len(rows) + n, np.int64)
            longer[:n_rows] = rows[:n_rows]
            rows = longer
        for place in range(groups[group], end):
            for k in range(starts[order[place]], starts[order[place] + 1]):
                other = places[neighbours[k]]
                if other >= end and seen[other] != group:
                    seen[other] = group
                    rows[n_rows] = other
                    n_rows += 1
        child = first_child[group]
        while child >= 0:
            for k in range(begins[child], begins[child + 1]):
                other = rows[k]
                if other >= end and seen[other] != group:
                    seen[other] = group
                    rows[n_rows] = other
                    n_rows += 1
            child = sibling[child]
        begins[group + 1] = n_rows
        if n_rows > begins[group]:
            rows[begins[group] : n_rows].sort()
            parent = group_of[rows[begins[group]]]
            parents[group], sibling[group], first_child[parent] = parent, first_child[parent], group
    return places, begins, rows[: begins[-1]].copy(), parents


@compiled
def _postorder(parents: IntArray) -> IntArray:
    """List the fronts so that each follows all that are below it, and nothing else comes between those."""
    n = len(parents)
    first_child, sibling = np.full(n + 1, -1), np.full(n, -1)
    for k in range(n - 1, -1, -1):
        sibling[k], first_child[parents[k]] = first_child[parents[k]], k
    sequence, n_listed = np.empty(n, np.int64), 0
    path, depth = np.empty(n + 1, np.int64), 1
    path[0] = n
    while depth > 0:
        current = path[depth - 1]
        child = first_child[current]
        if child >= 0:
            first_child[current] = sibling[child]
            path[depth] = child
            depth += 1
        else:
            depth -= 1
            if depth > 0:
                sequence[n_listed] = current
                n_listed += 1
    return sequence
