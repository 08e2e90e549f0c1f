"""Small meshes with known mathematics, made in code."""

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.reading.mesh import Colour, Mesh

SQUARE = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int64)


def icosahedron() -> tuple[FloatArray, IntArray]:
    """Return the regular icosahedron on the unit sphere."""
    golden = (1.0 + np.sqrt(5.0)) / 2.0
    short = np.array([[s, t * golden] for s in (-1.0, 1.0) for t in (-1.0, 1.0)])
    zero = np.zeros((4, 1))
    vertices = np.vstack(
        [np.hstack([zero, short]), np.hstack([short, zero]), np.hstack([short[:, 1:], zero, short[:, :1]])]
    )
    squares = np.sum((vertices[:, None] - vertices[None]) ** 2, axis=2)
    near = np.isclose(squares, 4.0)
    faces = [
        (i, j, k)
        for i in range(12)
        for j in range(i)
        for k in range(j)
        if near[i, j] and near[j, k] and near[i, k]
    ]
    return vertices / np.linalg.norm(vertices[0]), outwards(vertices, np.array(faces, dtype=np.int64))


def outwards(vertices: FloatArray, faces: IntArray) -> IntArray:
    """Turn the faces of a star-shaped surface around the origin so that their normals point outwards."""
    corners = vertices[faces]
    inside = np.linalg.det(corners) < 0
    return np.where(inside[:, None], faces[:, ::-1], faces)


def sphere(levels: int) -> tuple[FloatArray, IntArray]:
    """Subdivide the icosahedron on the unit sphere: 10 · 4^levels + 2 vertices."""
    vertices, faces = icosahedron()
    for _ in range(levels):
        halves = np.sort(np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
        edges, inverse = np.unique(halves, axis=0, return_inverse=True)
        ab, bc, ca = (len(vertices) + inverse.ravel()).reshape(3, -1)
        middles = vertices[edges].mean(axis=1)
        vertices = np.vstack([vertices, middles / np.linalg.norm(middles, axis=1, keepdims=True)])
        a, b, c = faces.T
        triples = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = np.vstack([np.column_stack(triple) for triple in triples])
    return vertices, faces


def sheet(n: int, width: float = 1.0, height: float = 1.0) -> tuple[FloatArray, IntArray]:
    """Triangulate a rectangle in the plane z = 0 with n × n squares."""
    x, y = np.meshgrid(np.linspace(0, width, n + 1), np.linspace(0, height, n + 1), indexing="ij")
    vertices = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    first = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    corners = np.column_stack([first, first + n + 1, first + n + 2, first + 1])
    return vertices, np.vstack([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])


def box() -> tuple[FloatArray, IntArray, FloatArray]:
    """Return the unit cube as 12 triangles, and (12, 3, 2) texture coordinates: an image on each side."""
    vertices = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.vstack([np.array(side)[SQUARE] for side in sides])
    unit_square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    return vertices, faces, np.tile(unit_square[SQUARE], (6, 1, 1))


def coloured(vertices: FloatArray, faces: IntArray, srgb: FloatArray) -> Mesh:
    """Make a mesh with a colour (n, 3) at each vertex."""
    return Mesh(
        vertices=vertices,
        faces=faces,
        corner_colours=srgb[faces],
        corner_uvs=np.zeros((len(faces), 3, 2)),
        face_textures=np.full(len(faces), -1, dtype=np.int64),
        textures=(),
        colour=Colour.VERTEX,
        warnings=(),
    )
