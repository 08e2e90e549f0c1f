"""A thumbnail shows the shape in its colours on a transparent ground."""

import io

import numpy as np
import pytest
from PIL import Image

from tests.shapes import SQUARE, coloured, sphere
from worker.arrays import ByteArray
from worker.geometry.repair import repair
from worker.pictures import thumbnail as module
from worker.pictures.thumbnail import thumbnail
from worker.reading.mesh import Colour, Mesh

RED, BLUE = (0.9, 0.1, 0.1), (0.1, 0.1, 0.9)


def _ball(colour: tuple[float, float, float], size: float = 1.0, place: float = 0.0) -> Mesh:
    vertices, faces = sphere(3)
    return coloured(size * vertices + place, faces, np.tile(np.array(colour), (len(vertices), 1)))


def _pixels(png: bytes) -> ByteArray:
    picture = Image.open(io.BytesIO(png))
    assert picture.format == "PNG"
    assert picture.mode == "RGBA"
    return np.asarray(picture)


def _draw(mesh: Mesh, size: int = 64) -> ByteArray:
    return _pixels(thumbnail(mesh, repair(mesh), size))


def test_a_red_sphere_is_a_red_disc_on_nothing() -> None:
    pixels = _draw(_ball(RED))
    assert pixels.shape == (64, 64, 4)
    assert (pixels[[0, 0, -1, -1], [0, -1, 0, -1], 3] == 0).all()
    covered = pixels[..., 3] == 255
    assert covered.mean() == pytest.approx(np.pi / 4 / 1.06**2, abs=0.03)
    red, green, blue = pixels[covered, :3].astype(float).T
    assert (red > 3 * green).all()
    assert (red > 3 * blue).all()


def test_edges_are_smooth() -> None:
    alpha = _draw(_ball(RED))[..., 3]
    assert ((alpha > 0) & (alpha < 255)).any()


def test_the_same_mesh_gives_the_same_bytes() -> None:
    mesh = _ball(RED)
    assert thumbnail(mesh, repair(mesh)) == thumbnail(mesh, repair(mesh))


def test_far_from_the_origin_looks_the_same() -> None:
    near = _draw(_ball(RED)).astype(int)
    far = _draw(_ball(RED, 1000.0, 5e5)).astype(int)
    assert np.abs(near - far).mean() < 0.5


def test_a_turned_face_keeps_its_corners_colours() -> None:
    square, straight = np.array([(0.0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]), SQUARE
    left_red = np.array([RED, BLUE, BLUE, RED])
    turned = np.array([(0, 1, 2), (3, 2, 0)])
    first = _draw(coloured(square, straight, left_red))
    second = _draw(coloured(square, turned, left_red))
    np.testing.assert_allclose(first.astype(int), second.astype(int), atol=1)


def test_a_texture_is_shown_where_it_lies() -> None:
    vertices = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], dtype=np.float64)
    faces = np.array([(0, 1, 2), (0, 2, 3)])
    texture = np.zeros((16, 16, 3), dtype=np.uint8)
    texture[:8, :, 0], texture[8:, :, 2] = 255, 255
    mesh = Mesh(
        vertices=vertices,
        faces=faces,
        corner_colours=np.zeros((2, 3, 3)),
        corner_uvs=vertices[faces][..., :2] * 0.98 + 0.01,
        face_textures=np.zeros(2, dtype=np.int64),
        textures=(texture,),
        colour=Colour.TEXTURE,
        warnings=(),
    )
    pixels = _draw(mesh).astype(int)
    rows = np.flatnonzero(pixels[..., 3].sum(1))
    upper, lower = pixels[rows[0] : rows[len(rows) // 3]], pixels[rows[2 * len(rows) // 3] : rows[-1]]
    assert upper[..., 0].sum() > 10 * upper[..., 2].sum()
    assert lower[..., 2].sum() > 10 * lower[..., 0].sum()


def test_a_heap_of_huge_triangles_is_drawn_coarser(monkeypatch: pytest.MonkeyPatch) -> None:
    generator = np.random.default_rng(0)
    faces = np.arange(600).reshape(-1, 3)
    mesh = coloured(generator.normal(size=(600, 3)), faces, generator.uniform(size=(600, 3)))
    monkeypatch.setattr(module, "MOST_PAIRS", 20_000)
    pixels = _draw(mesh)
    assert pixels.shape == (64, 64, 4)
    assert pixels[..., 3].max() == 255
