import numpy as np
import pytest

from tests.photograph import photograph
from tests.shapes import SQUARE, coloured, sheet
from worker.geometry.colour import look_up_colours, srgb_to_lab
from worker.reading.mesh import Colour, Mesh


def square_with(texture: np.ndarray) -> Mesh:
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    return Mesh(
        vertices=vertices,
        faces=SQUARE,
        corner_colours=np.ones((2, 3, 3)),
        corner_uvs=vertices[SQUARE][:, :, :2],
        face_textures=np.zeros(2, dtype=np.int64),
        textures=(texture,),
        colour=Colour.TEXTURE,
        warnings=(),
    )


@pytest.mark.parametrize(
    ("srgb", "lab"),
    [
        ([1.0, 1.0, 1.0], [100.0, 0.0, 0.0]),
        ([0.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
        ([1.0, 0.0, 0.0], [53.24, 80.09, 67.20]),
        ([0.0, 0.0, 1.0], [32.30, 79.19, -107.86]),
    ],
)
def test_lab_is_that_of_the_standard(srgb: list[float], lab: list[float]) -> None:
    np.testing.assert_allclose(srgb_to_lab(np.array([srgb])), [lab], atol=0.05)


def test_a_colour_between_vertices_is_their_mixture() -> None:
    vertices, faces = sheet(1)
    mesh = coloured(vertices, faces, np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]))
    places = np.array([[0.2, 0.3, 0.5]])
    found = look_up_colours(mesh, np.array([0]), places)
    np.testing.assert_allclose(found, places @ mesh.corner_colours[0])


def test_the_texel_under_a_point_is_the_one_that_painters_see() -> None:
    texture = np.zeros((2, 2, 3), np.uint8)
    texture[0, 0], texture[0, 1], texture[1, 0], texture[1, 1] = [255, 0, 0], [0, 255, 0], [0, 0, 255], 255
    # Face 0 is (0,0) (1,0) (1,1), face 1 is (0,0) (1,1) (0,1); v runs upwards, rows of an image downwards.
    faces = np.array([0, 0, 1])
    places = np.array([[0.8, 0.1, 0.1], [0.1, 0.1, 0.8], [0.1, 0.1, 0.8]])
    expected = [[0, 0, 1], [0, 1, 0], [1, 0, 0]]
    np.testing.assert_array_equal(look_up_colours(square_with(texture), faces, places), expected)


def test_coordinates_outside_0_to_1_repeat_the_texture() -> None:
    mesh = square_with(photograph(64))
    places = np.random.default_rng(0).dirichlet(np.ones(3), 50)
    faces = np.zeros(50, dtype=np.int64)
    moved = Mesh(**{**vars(mesh), "corner_uvs": mesh.corner_uvs + [3.0, -2.0]})
    expected = look_up_colours(mesh, faces, places, np.full(50, 1e-3))
    np.testing.assert_allclose(look_up_colours(moved, faces, places, np.full(50, 1e-3)), expected, atol=1e-9)


def test_a_point_that_stands_for_the_whole_image_has_its_mean_colour() -> None:
    texture = photograph(256)
    found = look_up_colours(square_with(texture), np.array([0]), np.array([[0.0, 0.5, 0.5]]), np.array([2.0]))
    np.testing.assert_allclose(found[0], texture.mean(axis=(0, 1)) / 255, atol=0.03)


def test_footprints_average_noise_away() -> None:
    noise = np.random.default_rng(0).integers(0, 256, (256, 256, 3)).astype(np.uint8)
    places = np.random.default_rng(1).dirichlet(np.ones(3), 500)
    faces = np.zeros(500, dtype=np.int64)
    raw = look_up_colours(square_with(noise), faces, places)
    smooth = look_up_colours(square_with(noise), faces, places, np.full(500, 0.01))  # 328 texels each
    assert smooth.std() < raw.std() / 8
