"""Boxes of twelve triangles that carry all their detail in a painted picture."""

import io

import numpy as np
from PIL import Image

from service.samples.colouring import PATTERNS, mix, rgb
from service.samples.palettes import random_coat
from service.samples.sample import Sample
from worker.arrays import ByteArray

CELLS = ((0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1))  # places of the six sides in the picture
CORNERS = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))  # outwards


def picture_box(name: str, generator: np.random.Generator, side: int = 128) -> Sample:
    """Return an OBJ of a box with its MTL and its PNG, six patterned sides of ``side``² pixels each."""
    size = generator.uniform(0.5, 1.5, 3)
    corners = [size * ((i >> 2) & 1, (i >> 1) & 1, i & 1) for i in range(8)]
    lines = ["mtllib box.mtl", *(f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in corners)]
    for column, row in CELLS:
        for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
            lines.append(f"vt {(column + 0.02 + 0.96 * u) / 3:.6f} {(row + 0.02 + 0.96 * v) / 2:.6f}")
    lines.append("usemtl picture")
    for number, around in enumerate(CORNERS):
        lines.append("f " + " ".join(f"{c + 1}/{4 * number + k + 1}" for k, c in enumerate(around)))
    image = io.BytesIO()
    Image.fromarray(_picture(generator, side)).save(image, "PNG")
    files = {
        "box.obj": "\n".join(lines).encode() + b"\n",
        "box.mtl": b"newmtl picture\nKd 1 1 1\nmap_Kd box.png\n",
        "box.png": image.getvalue(),
    }
    return Sample(name=name, files=files, metadata={"kind": "box", "pose": "still", "coat": "picture"})


def _picture(generator: np.random.Generator, side: int) -> ByteArray:
    picture = np.empty((2 * side, 3 * side, 3), dtype=np.uint8)
    y, x = np.mgrid[0:side, 0:side] / side
    for column, row in CELLS:
        coat = random_coat(generator)
        points = np.stack([x.ravel(), y.ravel(), x.ravel()], 1) / coat.scale
        marks = PATTERNS[coat.pattern](points, generator)
        colours = mix(np.broadcast_to(rgb(coat.base), points.shape), rgb(coat.mark), marks)
        tile = np.rint(255 * colours).astype(np.uint8).reshape(side, side, 3)
        picture[row * side : (row + 1) * side, column * side : (column + 1) * side] = tile
    return picture
