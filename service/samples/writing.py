"""Shells as files: a PLY with vertex colours."""

import numpy as np

from service.samples.shell import Shell, vertex_normals
from worker.arrays import FloatArray


def ply_bytes(shell: Shell) -> bytes:
    """Return a binary PLY with colours at the vertices."""
    colours = shell.paint(shell.rest, vertex_normals(shell.rest, shell.faces))
    header = [
        "ply",
        "format binary_little_endian 1.0",
        "comment made by code, as part of Faience",
        f"element vertex {len(shell.vertices)}",
        *(f"property float {axis}" for axis in "xyz"),
        *(f"property uchar {colour}" for colour in ("red", "green", "blue")),
        f"element face {len(shell.faces)}",
        "property list uchar int vertex_indices",
        "end_header\n",
    ]
    vertices = np.empty(len(shell.vertices), dtype=[("position", "<f4", 3), ("colour", "u1", 3)])
    vertices["position"], vertices["colour"] = shell.vertices, bytes_of(colours)
    faces = np.empty(len(shell.faces), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, shell.faces
    return "\n".join(header).encode() + vertices.tobytes() + faces.tobytes()


def bytes_of(colours: FloatArray) -> FloatArray:
    """Return colours in 0…1 as whole numbers in 0…255."""
    result: FloatArray = np.rint(np.clip(colours, 0.0, 1.0) * 255)
    return result
