"""A small GLB for a viewer in a browser. The only file that imports trimesh."""

from typing import Any

import numpy as np
import trimesh

from worker.arrays import FloatArray, IntArray
from worker.pictures.clustering import cluster

MOST_BYTES = 300_000  # of the whole file
OVERHEAD = 4_000  # of the file's JSON, at most
VERTEX_BYTES = 12 + 12 + 4  # position, normal, colour
FACE_BYTES = 12  # three indices
FIRST_GRID = 128  # cubes along the longest side, when a mesh must be made smaller


def preview(vertices: FloatArray, faces: IntArray, colours: FloatArray) -> bytes:
    """Write a mesh with vertex colours as GLB, made coarser where it would be over 300 kB.

    Parameters
    ----------
    vertices : (n, 3) array
    faces : (m, 3) array
    colours : (n, 3) array
        sRGB in 0…1. The file holds linear values, as glTF 2.0 (section 3.7.2.1) wants them.

    Returns
    -------
    bytes
    """
    mesh, grid = (vertices, faces, colours), FIRST_GRID
    while _too_large(mesh[0], mesh[1]) and grid > 1:
        mesh = cluster(vertices, faces, colours, grid)
        grid = int(grid / 1.2)
    if not len(mesh[1]):  # dust: every piece is smaller than a cube
        mesh = _largest(vertices, faces, colours)
    return _glb(*mesh)


def _largest(
    vertices: FloatArray, faces: IntArray, colours: FloatArray
) -> tuple[FloatArray, IntArray, FloatArray]:
    """Keep as many of the largest faces as fit."""
    a, b, c = (vertices[column] for column in faces.T)
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    count = (MOST_BYTES - OVERHEAD) // (3 * VERTEX_BYTES + FACE_BYTES)
    used, kept = np.unique(faces[np.argsort(-areas, kind="stable")[:count]], return_inverse=True)
    return vertices[used], kept.reshape(-1, 3), colours[used]


def _too_large(vertices: FloatArray, faces: IntArray) -> bool:
    return VERTEX_BYTES * len(vertices) + FACE_BYTES * len(faces) + OVERHEAD > MOST_BYTES


def _glb(vertices: FloatArray, faces: IntArray, colours: FloatArray) -> bytes:
    colours = np.clip(colours, 0.0, 1.0)
    linear = np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)
    opaque = np.full((len(vertices), 4), 255, dtype=np.uint8)
    opaque[:, :3] = np.rint(255 * linear)
    mesh = trimesh.Trimesh(vertices, faces, vertex_colors=opaque, process=False, validate=False)
    scene = trimesh.Scene(mesh)
    glb = scene.export(  # type: ignore[no-untyped-call]  # trimesh leaves it untyped
        file_type="glb", include_normals=True, tree_postprocessor=_add_matte_material
    )
    return bytes(glb)


def _add_matte_material(tree: dict[str, Any]) -> None:
    """Give the mesh a matte material: glTF's default is metal, which is black without surroundings."""
    matte = {"metallicFactor": 0.0, "roughnessFactor": 0.9}
    tree["materials"] = [{"pbrMetallicRoughness": matte, "doubleSided": True}]
    for mesh in tree["meshes"]:
        for primitive in mesh["primitives"]:
            primitive["material"] = 0
