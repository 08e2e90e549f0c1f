"""From any triangulation to the canonical one: same area, same resolution, evenly spread."""

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.compiled import compiled
from worker.errors import Code, MeshError
from worker.geometry.areas import edge_lengths
from worker.geometry.collapse import collapse_short_edges
from worker.geometry.refinement import split_long_edges

SHORTEST = 1 / 2  # of a canonical edge: shorter ones go before any is split, so that needles do not multiply
LONGEST = 4 / 3  # of a canonical edge: longer ones are split before collapsing (Botsch and Kobbelt 2004)
GROWTH = 10  # times the vertices wanted: what splitting may add, or a needle of 12 triangles takes minutes
SECTION = np.array(
    [0.7548776662466927, 0.5698402909980532]
)  # of the plastic number (Roberts 2018, R2 sequence)


def normalise_area(vertices: FloatArray, faces: IntArray, area: float) -> FloatArray:
    """Centre a mesh and scale it to a total area; (n, 3)."""
    centred = vertices - vertices.mean(axis=0)
    total = face_areas(centred, faces).sum()
    return np.asarray(centred * np.sqrt(area / total))


def edge_of(area: float, n_vertices: int) -> float:
    """Return the edge of an even triangulation: n vertices take √3/2 edge² each."""
    return float(np.sqrt(2.0 / np.sqrt(3.0) * area / n_vertices))


def resample(
    vertices: FloatArray, faces: IntArray, area: float, n_vertices: int
) -> tuple[FloatArray, IntArray]:
    """Triangulate a surface anew, evenly, at the canonical resolution.

    Parameters
    ----------
    vertices : (n, 3) array
    faces : (m, 3) array
    area : float
        Total area of the result, square units.
    n_vertices : int
        Vertices wanted. Fewer where an even mesh needs fewer; more where many small pieces do.

    Returns
    -------
    vertices : (n', 3) array
        Centred.
    faces : (m', 3) array

    Raises
    ------
    MeshError
        TOO_COMPLEX where the surface is so long and thin that splitting adds too many vertices.
    """
    vertices, faces = retriangulate(
        normalise_area(vertices, faces, area), faces, n_vertices, edge_of(area, n_vertices)
    )
    return normalise_area(vertices, faces, area), faces


def retriangulate(
    vertices: FloatArray, faces: IntArray, n_vertices: int, edge: float
) -> tuple[FloatArray, IntArray]:
    """Triangulate a surface anew where it is, with edges of about a length; otherwise as `resample`."""
    vertices, faces = _refine(vertices, faces, n_vertices, edge)
    return collapse_short_edges(vertices, faces, n_vertices)


def sample_surface(vertices: FloatArray, faces: IntArray, n_samples: int) -> tuple[IntArray, FloatArray]:
    """Spread points over a surface, each standing for the same area.

    Systematic sampling: equal steps along the summed areas of the faces, and a low-discrepancy sequence
    inside them; nothing is random.

    Parameters
    ----------
    vertices : (n, 3) array
    faces : (m, 3) array
    n_samples : int

    Returns
    -------
    face_indices : (n_samples,) array
    barycentrics : (n_samples, 3) array
    """
    summed = np.cumsum(face_areas(vertices, faces))
    face_indices = _steps(summed, n_samples)
    square = (0.5 + np.arange(1, n_samples + 1)[:, None] * SECTION) % 1.0  # (n_samples, 2)
    square = np.where(square.sum(axis=1, keepdims=True) > 1.0, 1.0 - square, square)
    return face_indices, np.column_stack([1.0 - square.sum(axis=1), square])


def _refine(
    vertices: FloatArray, faces: IntArray, n_vertices: int, edge: float
) -> tuple[FloatArray, IntArray]:
    """Split long edges by and by, and drop short ones on the way: needles would become ever more needles."""
    most = len(vertices) + GROWTH * n_vertices
    current = float(edge_lengths(vertices, faces).max())
    vertices, faces = collapse_short_edges(vertices, faces, n_vertices, SHORTEST * edge)
    while current > LONGEST * edge:
        current = max(current / 2.0, LONGEST * edge)
        vertices, faces = split_long_edges(vertices, faces, current)
        vertices, faces = collapse_short_edges(vertices, faces, n_vertices, SHORTEST * edge)
        _check_growth(len(vertices), most)
    return vertices, faces


def _check_growth(n_vertices: int, most: int) -> None:
    if n_vertices > most:
        raise MeshError(
            Code.TOO_COMPLEX,
            "The surface is too long and thin for its area: even triangles on it would have more than "
            f"{most:,} vertices.",
        )


@compiled
def face_areas(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Return the areas of faces (m, 3); (m,)."""
    areas = np.empty(len(faces))
    for face in range(len(faces)):
        a, b, c = vertices[faces[face, 0]], vertices[faces[face, 1]], vertices[faces[face, 2]]
        x, y, z = b[0] - a[0], b[1] - a[1], b[2] - a[2]
        u, v, w = c[0] - a[0], c[1] - a[1], c[2] - a[2]
        p, q, r = y * w - z * v, z * u - x * w, x * v - y * u
        areas[face] = np.sqrt(p * p + q * q + r * r) / 2.0
    return areas


@compiled
def _steps(summed: FloatArray, n_steps: int) -> IntArray:
    """Return where the middles of equal steps up to the last of some ascending sums lie among these."""
    places, place = np.empty(n_steps, dtype=np.int64), 0
    for step in range(n_steps):
        while place < len(summed) - 1 and summed[place] < (step + 0.5) * (summed[-1] / n_steps):
            place += 1
        places[step] = place
    return places
