"""A quick stand-in for the description of a mesh, with children that go wrong on demand."""

import io
import os
import time
from collections.abc import Mapping

import numpy as np
from PIL import Image

from worker.arrays import FloatArray, SingleArray
from worker.describe import Description, MeshFacts
from worker.descriptors.landmarks import LADDER, pack
from worker.parameters import Parameters
from worker.pictures.preview import preview
from worker.reading.limits import Limits
from worker.reading.mesh import Mesh
from worker.reading.upload import Upload, read_mesh

POINTS = 80  # surface points of a fake description
LANDMARKS = 32
WORDS = ("hks-0", "hks-0.05", "hks-0.1", "log-hks")


def describe_quickly(
    files: Mapping[str, bytes], allow_untextured: bool, parameters: Parameters, limits: Limits
) -> Description:
    """Read the mesh for real, then make numbers from its mean colour; a file's name may ask for trouble."""
    make_trouble(set(files))
    mesh = read_mesh(Upload(files=files, allow_untextured=allow_untextured), limits)
    return fake_description(mesh, parameters)


def make_trouble(names: set[str]) -> None:
    if "crash.ply" in names:
        os._exit(7)
    if "defect.ply" in names:
        raise KeyError("a defect of our own")
    if "hang.ply" in names:
        time.sleep(3600)
    if "eat.ply" in names:
        kept = [np.ones(2**24) for _ in range(2**12)]  # 128 MiB each
        raise AssertionError(f"nobody stopped it: {len(kept)}")


def fake_description(mesh: Mesh, parameters: Parameters) -> Description:
    colour = mesh.corner_colours.mean(axis=(0, 1))  # (3,)
    signatures = fake_signatures(float(colour[0]))
    facts = MeshFacts(
        vertices=len(mesh.vertices),
        faces=len(mesh.faces),
        components=1,
        area=1.0,
        colour=str(mesh.colour),
        warnings=mesh.warnings,
    )
    return Description(
        fingerprint=parameters.fingerprint(),
        facts=facts,
        blocks={
            "colour-histogram": np.resize(colour, 4096).astype(np.float32),
            "colour-curves": np.resize(colour, 144).astype(np.float32),
            "landmarks": fake_landmarks(100 * colour, signatures["landmark-ladder"]),
        },
        signatures=signatures,
        thumbnail=one_pixel(colour),
        preview=preview(mesh.vertices, mesh.faces, np.tile(colour, (len(mesh.vertices), 1))),
    )


def one_pixel(colour: FloatArray) -> bytes:
    """Return a PNG of one pixel."""
    file = io.BytesIO()
    Image.new("RGBA", (1, 1), tuple(int(255 * part) for part in colour)).save(file, "PNG")
    return file.getvalue()


def fake_signatures(level: float) -> dict[str, SingleArray]:
    """Return signatures that follow smoothly from a level in 0…1."""
    points = level + np.linspace(0, 1, POINTS)[:, None] * np.arange(1, 7)  # (POINTS, 6)
    signatures = {name: points.astype(np.float32) for name in WORDS}
    quantiles = (level + np.linspace(0, 1, 1024)).astype(np.float32)
    eigenvalues = np.linspace(0, 0.01, 10, dtype=np.float32)
    return signatures | {
        "areas": np.full(POINTS, 1 / POINTS, dtype=np.float32),
        "diffusion-geometric": quantiles,
        "diffusion-joint": quantiles,
        "eigenvalues-0": eigenvalues,
        "landmark-ladder": (-level * np.linspace(1, 2, LANDMARKS)[:, None] * np.log(LADDER)).astype(
            np.float32
        ),
        "meshhog": np.abs(np.sin(points @ np.ones((6, 1)) * np.arange(1, 97))).astype(np.float32),
    }


def fake_landmarks(lab: FloatArray, ladder: SingleArray) -> SingleArray:
    """Return landmarks of one colour, each with the same share."""
    placed = np.column_stack([np.tile(lab, (LANDMARKS, 1)), np.full(LANDMARKS, 1 / LANDMARKS)])
    return pack(ladder.astype(np.float64), placed).ravel().astype(np.float32)


def coloured_triangle(red: int = 200, green: int = 100, blue: int = 50) -> bytes:
    """Return an ASCII PLY of two triangles in one colour."""
    corners = ["0 0 0", "1 0 0", "0 1 0", "0 0 1"]
    lines = [
        "ply",
        "format ascii 1.0",
        "element vertex 4",
        *(f"property float {axis}" for axis in "xyz"),
        *(f"property uchar {channel}" for channel in ("red", "green", "blue")),
        "element face 2",
        "property list uchar int vertex_indices",
        "end_header",
        *(f"{corner} {red} {green} {blue}" for corner in corners),
        "3 0 1 2",
        "3 0 1 3",
    ]
    return ("\n".join(lines) + "\n").encode()
