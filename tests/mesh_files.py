"""Mesh files written in code, and the one way the tests read them."""

import io
from collections.abc import Callable, Mapping

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image

from worker.arrays import FloatArray, IntArray
from worker.errors import Code, MeshError
from worker.reading.limits import Limits
from worker.reading.mesh import Mesh
from worker.reading.upload import Upload, read_mesh

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
TEXTURED = f"mtllib m.mtl\n{TRIANGLE}usemtl a\nf 1/1 2/2 3/3\n"


def read(
    files: Mapping[str, bytes | str], *, allow_untextured: bool = False, limits: Limits | None = None
) -> Mesh:
    """Read files of text or bytes."""
    contents = {name: data.encode() if isinstance(data, str) else data for name, data in files.items()}
    return read_mesh(Upload(files=contents, allow_untextured=allow_untextured), limits or Limits())


def refusal(
    files: Mapping[str, bytes | str], *, allow_untextured: bool = False, limits: Limits | None = None
) -> Code:
    """Return the code with which files are refused."""
    with pytest.raises(MeshError) as caught:
        read(files, allow_untextured=allow_untextured, limits=limits)
    return caught.value.code


def attempt(work: Callable[[], object]) -> Code | None:
    """Return the code of a refusal, or None where the work is done; any other error is one."""
    try:
        work()
    except MeshError as caught:
        return caught.code
    return None


def png(pixels: npt.NDArray[np.uint8] | None = None) -> bytes:
    """Return an image; four unlike pixels unless given."""
    if pixels is None:
        pixels = np.array([[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [9, 9, 9]]], dtype=np.uint8)
    stream = io.BytesIO()
    Image.fromarray(pixels).save(stream, "PNG")
    return stream.getvalue()


def ply_header(form: str, n_vertices: int, n_faces: int, extra: str = "") -> bytes:
    """Return the header of a PLY file with float positions; `extra` follows those properties."""
    return (
        f"ply\nformat {form} 1.0\nelement vertex {n_vertices}\nproperty float x\nproperty float y\n"
        f"property float z\n{extra}element face {n_faces}\n"
        "property list uchar int vertex_indices\nend_header\n"
    ).encode()


def ply_ascii(vertices: FloatArray, faces: list[list[int]]) -> bytes:
    """Write polygons as a text PLY; positions keep their single precision."""
    rows = [" ".join(repr(float(np.float32(number))) for number in row) for row in vertices]
    rows += [" ".join(map(str, [len(face), *face])) for face in faces]
    return ply_header("ascii", len(vertices), len(faces)) + ("\n".join(rows) + "\n").encode()


def ply_binary(vertices: FloatArray, faces: list[list[int]], order: str = "<") -> bytes:
    """Write polygons as a binary PLY."""
    name = "binary_little_endian" if order == "<" else "binary_big_endian"
    body = vertices.astype(f"{order}f4").tobytes()
    for face in faces:
        body += bytes([len(face)]) + np.array(face, dtype=f"{order}i4").tobytes()
    return ply_header(name, len(vertices), len(faces)) + body


def area(vertices: FloatArray, faces: IntArray) -> float:
    """Return the total area of triangles."""
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)
