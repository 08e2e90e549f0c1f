"""Uploads made by number: the same number is always the same content, every number another one."""

import io
import zipfile

import numpy as np
from PIL import Image

CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)  # of a box
QUADS = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
KINDS = ("ply", "obj", "zip", "empty")
TEXTURED = 499_999  # a parcel of an OBJ with its MTL and its picture, which no other part of the soak sends
EMPTY = "zero_area"  # the code of the last kind, which only the worker finds

Parcel = dict[str, bytes]  # file name → content


def kind_of(number: int) -> str:
    """Return what a parcel is: a coloured PLY, an OBJ with its picture, a zip of that, or no surface."""
    return KINDS[3] if number % 9 == 8 else KINDS[number % 3]


def parcel(number: int) -> Parcel:
    """Return the files of an upload."""
    kind = kind_of(number)
    if kind == "empty":
        return {f"{number}.ply": _coloured(number, np.zeros_like(CORNERS) + number)}
    if kind == "ply":
        return {f"{number}.ply": _coloured(number, _box(number))}
    files = _textured(number)
    return files if kind == "obj" else {f"{number}.zip": _zipped(files)}


def _box(number: int) -> np.ndarray:
    """Return corners (8, 3) of a box that leans its own way."""
    random = np.random.default_rng(number)
    return CORNERS * random.uniform(0.3, 2.0, 3) + 0.1 * random.standard_normal(CORNERS.shape)


def _coloured(number: int, corners: np.ndarray) -> bytes:
    colours = np.random.default_rng([number, 1]).integers(0, 256, (8, 3))
    lines = [
        "ply",
        "format ascii 1.0",
        "element vertex 8",
        *(f"property float {axis}" for axis in "xyz"),
        *(f"property uchar {channel}" for channel in ("red", "green", "blue")),
        "element face 6",
        "property list uchar int vertex_indices",
        "end_header",
        *(f"{x} {y} {z} {r} {g} {b}" for (x, y, z), (r, g, b) in zip(corners, colours, strict=True)),
        *(f"4 {a} {b} {c} {d}" for a, b, c, d in QUADS),
    ]
    return ("\n".join(lines) + "\n").encode()


def _textured(number: int) -> Parcel:
    stem = f"{number}"
    lines = [f"mtllib {stem}.mtl", "usemtl skin", "vt 0 0", "vt 1 0", "vt 1 1", "vt 0 1"]
    lines += [f"v {x} {y} {z}" for x, y, z in _box(number)]
    lines += [f"f {a + 1}/1 {b + 1}/2 {c + 1}/3 {d + 1}/4" for a, b, c, d in QUADS]
    pixels = np.random.default_rng([number, 2]).integers(0, 256, (8, 8, 3)).astype(np.uint8)
    picture = io.BytesIO()
    Image.fromarray(pixels).save(picture, "PNG")
    return {
        f"{stem}.obj": ("\n".join(lines) + "\n").encode(),
        f"{stem}.mtl": f"newmtl skin\nmap_Kd {stem}.png\n".encode(),
        f"{stem}.png": picture.getvalue(),
    }


def _zipped(files: Parcel) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, content in files.items():
            archive.writestr(zipfile.ZipInfo(name), content)  # no clock: the same bytes every time
    return stream.getvalue()
