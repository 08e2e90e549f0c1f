"""A preview is a small GLB that holds the same mesh and colours."""

import json
import struct
from typing import Any

import numpy as np
import pytest

from tests.shapes import sheet
from worker.arrays import FloatArray, IntArray
from worker.pictures.preview import MOST_BYTES, preview

TYPES = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}


class Glb:
    """The first mesh of a GLB, read by the letter of glTF 2.0."""

    def __init__(self, content: bytes) -> None:
        magic, version, length = struct.unpack_from("<4sII", content)
        assert (magic, version, length) == (b"glTF", 2, len(content))
        size = struct.unpack_from("<I", content, 12)[0]
        self.tree: dict[str, Any] = json.loads(content[20 : 20 + size])
        self._binary = content[20 + size + 8 :]
        primitive = self.tree["meshes"][0]["primitives"][0]
        self.material = self.tree["materials"][primitive["material"]]
        self.positions = self._read(primitive["attributes"]["POSITION"])
        self.normals = self._read(primitive["attributes"]["NORMAL"])
        self.colours = self._read(primitive["attributes"]["COLOR_0"])
        self.faces = self._read(primitive["indices"]).reshape(-1, 3)

    def _read(self, number: int) -> FloatArray:
        accessor = self.tree["accessors"][number]
        view = self.tree["bufferViews"][accessor["bufferView"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        width = WIDTHS[accessor["type"]]
        values = np.frombuffer(
            self._binary, TYPES[accessor["componentType"]], accessor["count"] * width, start
        )
        return values.reshape(-1, width).astype(np.float64)


def _waves(n: int) -> tuple[FloatArray, IntArray]:
    vertices, faces = sheet(n)
    vertices[:, 2] = 0.1 * np.sin(6 * vertices[:, 0])
    return vertices, faces


def test_the_same_vertices_faces_and_colours_come_back() -> None:
    vertices, faces = _waves(30)
    colours = np.random.default_rng(0).uniform(size=vertices.shape)
    glb = Glb(preview(vertices, faces, colours))
    np.testing.assert_allclose(glb.positions, vertices, atol=1e-6)
    np.testing.assert_array_equal(glb.faces, faces)
    linear = glb.colours[:, :3] / 255
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    np.testing.assert_allclose(srgb, colours, atol=0.027)
    assert (glb.colours[:, 3] == 255).all()


def test_normals_are_of_unit_length() -> None:
    vertices, faces = _waves(10)
    np.testing.assert_allclose(
        np.linalg.norm(Glb(preview(vertices, faces, vertices)).normals, axis=1), 1, atol=1e-5
    )


def test_the_material_is_matte() -> None:
    vertices, faces = _waves(4)
    material = Glb(preview(vertices, faces, np.clip(vertices, 0, 1))).material
    assert material["pbrMetallicRoughness"]["metallicFactor"] == 0


@pytest.mark.parametrize("side", [60, 90, 250])
def test_the_file_stays_small_and_the_shape_stays_whole(side: int) -> None:
    vertices, faces = _waves(side)
    content = preview(vertices, faces, np.clip(vertices, 0, 1))
    assert len(content) < MOST_BYTES
    glb = Glb(content)
    assert len(glb.faces) > 3000
    np.testing.assert_allclose(np.ptp(glb.positions, axis=0), np.ptp(vertices, axis=0), atol=0.03)


def test_dust_still_gives_a_small_mesh() -> None:
    generator = np.random.default_rng(0)
    places = generator.uniform(size=(9_000, 1, 3))
    vertices = (places + 1e-7 * generator.normal(size=(9_000, 3, 3))).reshape(-1, 3)
    content = preview(vertices, np.arange(27_000).reshape(-1, 3), np.full(vertices.shape, 0.5))
    assert len(content) < MOST_BYTES
    assert len(Glb(content).faces) > 0
