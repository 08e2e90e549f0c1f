"""Collapsing short edges: fewer vertices, evenly spread, close to the surface.

The shortest edges go first, level by level; a new vertex minimises the quadric error of Garland and
Heckbert (1997).
"""

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.compiled import compiled
from worker.geometry.edges import find_edges
from worker.geometry.linked_surface import LinkedSurface, compact, linked, merge, n_shared, valence
from worker.geometry.quadrics import plane_quadrics

MANY = 4  # times the vertices wanted, above which levels are coarser
COARSE, FINE = 1.25, 1.1  # growth of a level's length
SCATTER = 8  # every so manieth vertex is visited in turn, as the last level ends amid a visit
PENALTY = 2.0  # by which the squares of edges at a vertex look longer after each refused collapse
GIVE_UP = 1e4  # penalty from which an edge is left alone
MIDDLE = 1e-2  # pull of the middle of the edge, relative to the quadric
TURN = 0.2  # cosine of the largest turn of a triangle, about 80°


def collapse_short_edges(
    vertices: FloatArray, faces: IntArray, n_vertices: int, longest: float = np.inf
) -> tuple[FloatArray, IntArray]:
    """Collapse short edges until few enough vertices are left.

    The topology stays (link condition of Dey et al. 1999), no triangle turns over, boundaries keep their
    line.

    Parameters
    ----------
    vertices : (n, 3) array
    faces : (m, 3) array
    n_vertices : int
        How many vertices to keep. More are kept where the topology does not allow so few.
    longest : float
        Edges over this length stay.

    Returns
    -------
    vertices : (n', 3) array
    faces : (m', 3) array
    """
    if len(vertices) <= n_vertices:
        return vertices, faces
    edges = find_edges(faces)
    border = np.zeros(len(vertices), dtype=np.bool_)
    border[edges.ends[edges.n_faces == 1]] = True
    quadrics = plane_quadrics(vertices, faces, (edges.n_faces == 1)[edges.of_faces])
    surface = linked(vertices.copy(), faces.copy(), quadrics, border)
    if len(vertices) > MANY * n_vertices:
        _run(surface, MANY * n_vertices, longest**2, COARSE**2, 1)
        surface = linked(*compact(surface))
    _run(surface, n_vertices, longest**2, FINE**2, SCATTER)
    return compact(surface)[:2]


@compiled
def _run(surface: LinkedSurface, n_vertices: int, longest: float, growth: float, scatter: int) -> None:
    """Collapse edges up to a level, then up to a higher one; all in squared lengths."""
    left, searches, point = len(surface.first), 0, np.empty(3)
    level = min(_mean_square(surface) / 4.0, longest)
    while left > n_vertices:
        shortest = np.inf  # of the edges beyond this level
        for start in range(scatter):
            for vertex in range(start, len(surface.first), scatter):
                while surface.first[vertex] >= 0:
                    other, cost = _nearest(surface, vertex, longest)
                    if cost > level:
                        shortest = min(shortest, cost)
                        break
                    searches += 1
                    if _try(surface, vertex, other, point, searches):
                        left -= 1
                        if left == n_vertices:
                            return
        if shortest == np.inf:
            return
        level = max(level, shortest) * growth


@compiled
def _mean_square(surface: LinkedSurface) -> float:
    total = 0.0
    for face in range(len(surface.faces)):
        for corner in range(3):
            total += _square(surface, surface.faces[face, corner], surface.faces[face, (corner + 1) % 3])
    return total / surface.faces.size


@compiled
def _square(surface: LinkedSurface, start: int, end: int) -> float:
    x = surface.vertices[start, 0] - surface.vertices[end, 0]
    y = surface.vertices[start, 1] - surface.vertices[end, 1]
    z = surface.vertices[start, 2] - surface.vertices[end, 2]
    return float(x * x + y * y + z * z)


@compiled
def _nearest(surface: LinkedSurface, vertex: int, longest: float) -> tuple[int, float]:
    """Return the neighbour at the end of the edge that looks shortest, and its square; −1 and ∞ for none."""
    best, least = -1, np.inf
    corner = surface.first[vertex]
    while corner >= 0:
        for place in range(3):
            other = surface.faces[corner // 3, place]
            penalty = max(surface.penalties[vertex], surface.penalties[other])
            if other != vertex and penalty < GIVE_UP:
                square = _square(surface, vertex, other)
                if square <= longest and square * penalty < least:
                    best, least = other, square * penalty
        corner = surface.following[corner]
    return best, least


@compiled
def _try(surface: LinkedSurface, kept: int, gone: int, point: FloatArray, search: int) -> bool:
    """Collapse an edge where that is allowed; otherwise let its surroundings look longer."""
    allowed = _keeps_topology(surface, kept, gone, 2 * search)
    if allowed:
        _settle(surface, kept, gone, point)
        allowed = not (_turns(surface, kept, gone, point) or _turns(surface, gone, kept, point))
    if not allowed:
        surface.penalties[kept] *= PENALTY
        surface.penalties[gone] *= PENALTY
        return False
    for axis in range(3):
        surface.vertices[kept, axis] = point[axis]
    for entry in range(9):
        surface.quadrics[kept, entry] += surface.quadrics[gone, entry]
    surface.border[kept] |= surface.border[gone]
    merge(surface, kept, gone)
    return True


@compiled
def _keeps_topology(surface: LinkedSurface, start: int, end: int, mark: int) -> bool:
    """Check the link condition: the ends share as many neighbours as the edge has faces.

    Tetrahedra and lone triangles meet it as well, and would vanish.
    """
    n_faces = 0
    corner = surface.first[start]
    while corner >= 0:
        for place in range(3):
            other = surface.faces[corner // 3, place]
            surface.marks[other] = mark
            n_faces += other == end
        corner = surface.following[corner]
    if n_faces > 1 and surface.border[start] and surface.border[end]:
        return False  # two borders would touch
    surface.marks[start] = surface.marks[end] = mark + 1
    common, threefold, apex = 0, 0, -1
    corner = surface.first[end]
    while corner >= 0:
        for place in range(3):
            other = surface.faces[corner // 3, place]
            if surface.marks[other] == mark:
                surface.marks[other] = mark + 1
                common, apex = common + 1, other
                threefold += valence(surface, other) == 3
        corner = surface.following[corner]
    if common != n_faces or threefold > 1:
        return False
    return n_faces > 1 or n_shared(surface, start, apex) > 1 or n_shared(surface, end, apex) > 1


@compiled
def _settle(surface: LinkedSurface, kept: int, gone: int, point: FloatArray) -> None:
    """Minimise the quadric error by Cramer's rule, pulled a little to the middle for flat places."""
    first, second, vertices = surface.quadrics[kept], surface.quadrics[gone], surface.vertices
    xx, xy, xz = first[0] + second[0], first[1] + second[1], first[2] + second[2]
    yy, yz, zz = first[3] + second[3], first[4] + second[4], first[5] + second[5]
    u = (vertices[kept, 0] + vertices[gone, 0]) / 2.0
    v = (vertices[kept, 1] + vertices[gone, 1]) / 2.0
    w = (vertices[kept, 2] + vertices[gone, 2]) / 2.0
    x = first[6] + second[6] - (xx * u + xy * v + xz * w)
    y = first[7] + second[7] - (xy * u + yy * v + yz * w)
    z = first[8] + second[8] - (xz * u + yz * v + zz * w)
    pull = MIDDLE * (xx + yy + zz)
    xx, yy, zz = xx + pull, yy + pull, zz + pull
    a, b, c = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
    d, e, f = xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy
    determinant = xx * a + xy * b + xz * c
    scale = 1.0 / determinant if determinant > 0.0 else 0.0
    point[0] = u + scale * (a * x + b * y + c * z)
    point[1] = v + scale * (b * x + d * y + e * z)
    point[2] = w + scale * (c * x + e * y + f * z)


@compiled
def _turns(surface: LinkedSurface, vertex: int, other: int, point: FloatArray) -> bool:
    """Tell whether a triangle at one end but not the other would turn too far; one without area cannot."""
    corner, here = surface.first[vertex], surface.vertices[vertex]
    while corner >= 0:
        face = corner // 3
        start, end = surface.faces[face, (corner + 1) % 3], surface.faces[face, (corner + 2) % 3]
        if start != other and end != other:
            x, y, z = _doubled(surface.vertices[start], surface.vertices[end], here)
            u, v, w = _doubled(surface.vertices[start], surface.vertices[end], point)
            before, after = x * x + y * y + z * z, u * u + v * v + w * w
            if before > 0.0 and x * u + y * v + z * w <= TURN * np.sqrt(before * after):
                return True
        corner = surface.following[corner]
    return False


@compiled
def _doubled(a: FloatArray, b: FloatArray, c: FloatArray) -> tuple[float, float, float]:
    """Return the normal of a triangle, twice as long as its area."""
    x, y, z = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    u, v, w = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    return y * w - z * v, z * u - x * w, x * v - y * u
