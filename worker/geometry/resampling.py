"""From any triangulation to the canonical one: same area, same resolution, evenly spread."""

import fast_simplification
import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.geometry.areas import edge_lengths, face_vectors, norms
from worker.geometry.collapse import collapse_short_edges
from worker.geometry.refinement import split_long_edges

FINE = 4  # meshes over this many times the canonical resolution are thinned by a faster method first
SHORTEST = 1 / 2  # of a canonical edge: shorter ones go before any is split, so that needles do not multiply
WORTHWHILE = 0.01  # share of the vertices for which another round of that is run
LONGEST = 4 / 3  # of a canonical edge: longer ones are split before collapsing (Botsch and Kobbelt 2004)
SECTION = np.array(
    [0.7548776662466927, 0.5698402909980532]
)  # of the plastic number (Roberts 2018, R2 sequence)


def normalise_area(vertices: FloatArray, faces: IntArray, area: float) -> FloatArray:
    """Centre a mesh and scale it to a total area; (n, 3)."""
    centred = vertices - vertices.mean(axis=0)
    total = norms(face_vectors(centred, faces)).sum()
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
    """
    vertices = normalise_area(vertices, faces, area)
    if len(vertices) > FINE * n_vertices:
        vertices, faces = _thin(vertices, faces, FINE * n_vertices)
    vertices, faces = _refine(vertices, faces, n_vertices, edge_of(area, n_vertices))
    vertices, faces = collapse_short_edges(vertices, faces, n_vertices)
    return normalise_area(vertices, faces, area), faces


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
    summed = np.cumsum(norms(face_vectors(vertices, faces)))
    steps = (np.arange(n_samples) + 0.5) * (summed[-1] / n_samples)
    face_indices = np.minimum(np.searchsorted(summed, steps), len(faces) - 1)
    square = (0.5 + np.arange(1, n_samples + 1)[:, None] * SECTION) % 1.0  # (n_samples, 2)
    square = np.where(square.sum(axis=1, keepdims=True) > 1.0, 1.0 - square, square)
    return face_indices, np.column_stack([1.0 - square.sum(axis=1), square])


def _refine(
    vertices: FloatArray, faces: IntArray, n_vertices: int, edge: float
) -> tuple[FloatArray, IntArray]:
    """Split long edges by and by, and drop short ones on the way: needles would become ever more needles."""
    current = float(edge_lengths(vertices, faces).max())
    vertices, faces = collapse_short_edges(vertices, faces, n_vertices, SHORTEST * edge, WORTHWHILE)
    while current > LONGEST * edge:
        current = max(current / 2.0, LONGEST * edge)
        vertices, faces = split_long_edges(vertices, faces, current)
        vertices, faces = collapse_short_edges(vertices, faces, n_vertices, SHORTEST * edge, WORTHWHILE)
    return vertices, faces


def _thin(vertices: FloatArray, faces: IntArray, n_vertices: int) -> tuple[FloatArray, IntArray]:
    """Reduce a very fine mesh by quadric decimation, and drop what that leaves unused."""
    share = 1.0 - n_vertices / len(vertices)
    thinned, triangles = fast_simplification.simplify(
        vertices, faces.astype(np.int32), target_reduction=min(max(share, 0.0), 0.999)
    )
    used, inverse = np.unique(triangles, return_inverse=True)
    return np.asarray(thinned, dtype=np.float64)[used], inverse.reshape(-1, 3).astype(np.int64)
