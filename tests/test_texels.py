import numpy as np

from worker.geometry.texels import interpolate, levels_of, read_between, read_nearest


def test_values_mix_by_their_shares() -> None:
    corners = np.random.default_rng(0).uniform(size=(4, 3, 5))
    shares, faces = np.random.default_rng(1).dirichlet(np.ones(3), 6), np.array([3, 0, 1, 1, 2, 0])
    expected = np.einsum("kc,kcd->kd", shares, corners[faces])
    np.testing.assert_allclose(interpolate(corners, faces, shares), expected)


def test_a_level_has_texels_as_large_as_a_point_stands_for() -> None:
    whole = np.array([[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]])  # half of the image
    faces, footprints = np.zeros(4, dtype=np.int64), np.array([2 / 64**2, 2 / 32**2, 2 / 16**2, 1e-9])
    assert levels_of(whole, faces, footprints, 64**2).tolist() == [0, 1, 2, 0]


def test_between_texels_an_image_is_linear() -> None:
    ramp = np.zeros((4, 8, 3), np.uint8)
    ramp[:] = 16 * np.arange(8)[:, None]
    uvs = np.column_stack([np.linspace(0.1, 0.9, 7), np.full(7, 0.5)])
    colours = np.zeros((7, 3))
    read_between(ramp, uvs, np.arange(7), colours)
    np.testing.assert_allclose(colours[:, 0] * 255, 16 * (8 * uvs[:, 0] - 0.5))


def test_only_the_chosen_points_are_read() -> None:
    colours = np.full((3, 3), 9.0)
    read_nearest(np.zeros((2, 2, 3), np.uint8), np.zeros((3, 2)), np.array([1]), colours)
    assert colours[:, 0].tolist() == [9.0, 0.0, 9.0]
