"""Parts of meshes, and meshes put together."""

from dataclasses import replace

import numpy as np

from worker.arrays import BoolArray, FloatArray, IntArray
from worker.reading.mesh import Mesh


def select_faces(mesh: Mesh, kept: BoolArray) -> Mesh:
    """Keep some of the faces; vertices stay, used or not."""
    return replace(
        mesh,
        faces=mesh.faces[kept],
        corner_colours=mesh.corner_colours[kept],
        corner_uvs=mesh.corner_uvs[kept],
        face_textures=mesh.face_textures[kept],
    )


def append(mesh: Mesh, other: Mesh) -> Mesh:
    """Put two meshes together; the second has no images of its own."""
    return replace(
        mesh,
        vertices=np.vstack([mesh.vertices, other.vertices]),
        faces=np.vstack([mesh.faces, other.faces + len(mesh.vertices)]),
        corner_colours=np.concatenate([mesh.corner_colours, other.corner_colours]),
        corner_uvs=np.concatenate([mesh.corner_uvs, other.corner_uvs]),
        face_textures=np.concatenate([mesh.face_textures, other.face_textures]),
    )


def painted(mesh: Mesh, vertices: FloatArray, faces: IntArray, colours: FloatArray) -> Mesh:
    """Return new triangles with colours (m, 3, 3) at their corners, fit to be appended to a mesh."""
    return replace(
        mesh,
        vertices=vertices,
        faces=faces,
        corner_colours=np.array(colours),
        corner_uvs=np.zeros((len(faces), 3, 2)),
        face_textures=np.full(len(faces), -1),
    )
