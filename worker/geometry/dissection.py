"""Nested dissection: an order in which a sparse symmetric matrix is eliminated with little fill.

George (1973), "Nested dissection of a regular finite element mesh". A set of vertices is cut in two by a
plane across a coordinate axis; those of the lower side that touch the upper one are eliminated last. Of all
planes that leave no side too small, the one with the fewest such vertices is taken, so that a body is cut at
its wrists and ankles.
"""

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.compiled import compiled

LEAF = 24  # sets of no more vertices are not cut
PLACES = 1024  # along the longest axis, at which it may be cut
LEAST_SIDE = 0.2  # of a set
IMBALANCE = 2.0  # how much worse a separator is where one side is empty, less one


def dissect(points: FloatArray, starts: IntArray, neighbours: IntArray) -> tuple[IntArray, IntArray]:
    """Order the vertices of a graph, and group those that are eliminated together.

    Parameters
    ----------
    points : (n, d ≥ 3) array
        Where the vertices lie, in any units; the first three columns count, and only for the fill.
    starts : (n + 1,) array
    neighbours : (e,) array
        Those of vertex i are neighbours[starts[i]:starts[i + 1]], in both directions of each edge.

    Returns
    -------
    order : (n,) array
        Vertices as they are eliminated.
    groups : (g + 1,) array
        Group k is order[groups[k]:groups[k + 1]]: a set that was not cut, or a separator.
    """
    heights = points[:, :3] - points[:, :3].min(axis=0)
    places = (heights * ((PLACES - 1) / (heights.max() or 1.0))).astype(np.int64)
    return _dissected(places, starts, neighbours)


@compiled
def _dissected(places: IntArray, starts: IntArray, neighbours: IntArray) -> tuple[IntArray, IntArray]:
    n = len(places)
    order, owner = np.arange(n), np.zeros(n, np.int64)
    buffers = np.empty((2, n), np.int64)
    is_start = np.zeros(n + 1, np.bool_)
    is_start[n] = True
    waiting = np.zeros((n + 2, 3), np.int64)  # begin, end and number of a set
    waiting[0, 1] = n
    n_sets, n_waiting = 1, 1
    while n_waiting > 0:
        n_waiting -= 1
        low, high, own = waiting[n_waiting]
        is_start[low] = True
        if high - low <= LEAF:
            continue
        axis, plane = _best_plane(places, starts, neighbours, order[low:high], owner, own)
        if axis < 0:
            continue
        middle, last = _cut(places[:, axis], plane, starts, neighbours, order[low:high], owner, own, buffers)
        is_start[low + last] = True
        for begin, end in ((low, low + middle), (low + middle, low + last)):
            owner[order[begin:end]] = n_sets
            waiting[n_waiting] = begin, end, n_sets
            n_sets += 1
            n_waiting += 1
        owner[order[low + last : high]] = -1
    return order, np.flatnonzero(is_start)


@compiled
def _best_plane(  # noqa: C901 - compiled: one loop, plainly
    places: IntArray, starts: IntArray, neighbours: IntArray, vertices: IntArray, owner: IntArray, own: int
) -> tuple[int, int]:
    """Return axis and place of the best cut of a set; −1 where there is none."""
    first, last = np.full(3, PLACES), np.zeros(3, np.int64)
    for vertex in vertices:
        for axis in range(3):
            first[axis] = min(first[axis], places[vertex, axis])
            last[axis] = max(last[axis], places[vertex, axis])
    width = (last - first).max() + 1
    inside, crossing = np.zeros((3, width), np.int64), np.zeros((3, width), np.int64)
    for vertex in vertices:
        x, y, z = places[vertex, 0], places[vertex, 1], places[vertex, 2]
        farthest_x, farthest_y, farthest_z = x, y, z
        for k in range(starts[vertex], starts[vertex + 1]):
            other = neighbours[k]
            if owner[other] == own:
                farthest_x = max(farthest_x, places[other, 0])
                farthest_y = max(farthest_y, places[other, 1])
                farthest_z = max(farthest_z, places[other, 2])
        for axis, place, farthest in ((0, x, farthest_x), (1, y, farthest_y), (2, z, farthest_z)):
            inside[axis, place - first[axis]] += 1
            crossing[axis, place - first[axis]] += 1
            crossing[axis, farthest - first[axis]] -= 1
    best, best_axis, best_plane = np.inf, -1, 0
    for axis in range(3):
        separator, lower = 0, 0
        for plane in range(last[axis] - first[axis]):
            separator += crossing[axis, plane]
            lower += inside[axis, plane]
            least = min(lower - separator, len(vertices) - lower)
            if least > LEAST_SIDE * len(vertices):
                cost = separator * (1.0 + IMBALANCE * (0.5 - least / len(vertices)))
                if cost < best:
                    best, best_axis, best_plane = cost, axis, plane + first[axis]
    return best_axis, best_plane


@compiled
def _cut(
    places: IntArray,
    plane: int,
    starts: IntArray,
    neighbours: IntArray,
    vertices: IntArray,
    owner: IntArray,
    own: int,
    buffers: IntArray,
) -> tuple[int, int]:
    """Sort a set in place into lower side, upper side and separator; return where the last two begin."""
    n_lower, n_upper, n_last = 0, 0, 0
    for vertex in vertices:
        if places[vertex] > plane:
            buffers[0, n_upper] = vertex
            n_upper += 1
            continue
        crosses = False
        for k in range(starts[vertex], starts[vertex + 1]):
            other = neighbours[k]
            crosses |= owner[other] == own and places[other] > plane
        if crosses:
            buffers[1, n_last] = vertex
            n_last += 1
        else:
            vertices[n_lower] = vertex
            n_lower += 1
    vertices[n_lower : n_lower + n_upper] = buffers[0, :n_upper]
    vertices[n_lower + n_upper :] = buffers[1, :n_last]
    return n_lower, n_lower + n_upper
