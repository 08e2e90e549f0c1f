"""A job in small: whatever is compiled or loaded on first use is, before children are forked."""

import io
from collections.abc import Mapping

import numpy as np
from PIL import Image

from index.vocabulary import default_vocabulary
from service.quantisation import quantise
from worker.describe import describe
from worker.parameters import Parameters
from worker.reading.upload import Upload

SIDE = 13  # vertices along a side of the sheet
SMALL = Parameters(vertices=40, colour_samples=200, distance_samples=20, distance_quantiles=16, landmarks=8)


def rehearse() -> None:
    """Describe a sheet with a picture on it, and one with coloured vertices."""
    for files in (_textured(), _coloured()):
        description = describe(Upload(files=files), SMALL)
        quantise(description.signatures, default_vocabulary())


def _textured() -> Mapping[str, bytes]:
    picture = io.BytesIO()
    Image.fromarray(np.arange(192, dtype=np.uint8).reshape(8, 8, 3)).save(picture, "PNG")
    points, faces = _sheet()
    lines = ["mtllib a.mtl", "usemtl a"]
    lines += [f"v {x} {y} {z}\nvt {x / SIDE} {y / SIDE}" for x, y, z in points]
    lines += [f"f {a}/{a} {b}/{b} {c}/{c}" for a, b, c in faces + 1]
    return {
        "a.obj": "\n".join(lines).encode(),
        "a.mtl": b"newmtl a\nmap_Kd a.png\n",
        "a.png": picture.getvalue(),
    }


def _coloured() -> Mapping[str, bytes]:
    points, faces = _sheet()
    header = ["ply", "format ascii 1.0", f"element vertex {len(points)}"]
    header += [f"property float {name}" for name in "xyz"]
    header += [f"property uchar {name}" for name in ("red", "green", "blue")]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    lines = [f"{x} {y} {z} {20 * x} {20 * y} 99" for x, y, z in points]
    lines += [f"3 {a} {b} {c}" for a, b, c in faces]
    return {"a.ply": "\n".join([*header, *lines, ""]).encode()}


def _sheet() -> tuple[np.ndarray, np.ndarray]:
    """Return points (n, 3), whole numbers, and faces (m, 3) of a waved sheet."""
    x, y = (axis.ravel() for axis in np.indices((SIDE, SIDE)))
    here = np.arange(SIDE * SIDE).reshape(SIDE, SIDE)
    first, second, third, fourth = here[:-1, :-1], here[1:, :-1], here[1:, 1:], here[:-1, 1:]
    corners = [np.stack([first, second, third], axis=-1), np.stack([first, third, fourth], axis=-1)]
    return np.column_stack([x, y, (x * y) % 3]), np.concatenate(corners).reshape(-1, 3)
