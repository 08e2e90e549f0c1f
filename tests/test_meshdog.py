from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

from tests.shapes import sheet, sphere
from worker.arrays import FloatArray, IntArray
from worker.canonical import Surface, canonical_surface
from worker.descriptors.meshdog import are_corners, differences_of_gaussians, meshdog
from worker.geometry.areas import vertex_normals
from worker.geometry.gradients import gradient_operator, tangent_hessians
from worker.geometry.repair import repair
from worker.geometry.rings import one_rings
from worker.parameters import Parameters
from worker.reading.limits import Limits
from worker.reading.upload import Upload, read_mesh

SHEET = sheet(60, 120.0, 120.0)
MIDDLE = 30 * 61 + 30


def bump(vertices: FloatArray, width: float, length: float) -> FloatArray:
    """Raise a Gaussian in the middle of the sheet."""
    x, y = vertices[:, 0] - 60.0, vertices[:, 1] - 60.0
    return 50.0 * np.exp(-((x / width) ** 2 + (y / length) ** 2) / 2.0)


def speckled(levels: int, seed: int = 0) -> tuple[FloatArray, FloatArray, IntArray]:
    vertices, faces = sphere(levels)
    return np.random.default_rng(seed).uniform(0.0, 100.0, len(vertices)), vertices, faces


def extrema_by_definition(differences: FloatArray, faces: IntArray) -> set[int]:
    """Compare each vertex with all its neighbours in space and scale."""
    found = set()
    for vertex in range(differences.shape[1]):
        around = sorted({v for face in faces.tolist() if vertex in face for v in face} - {vertex})
        for level in range(1, len(differences) - 1):
            value = differences[level, vertex]
            rest = np.append(
                differences[level - 1 : level + 2, around], differences[[level - 1, level + 1], vertex]
            )
            if (value > 0 and value > rest.max()) or (value < 0 and value < rest.min()):
                found.add(vertex)
    return found


@pytest.mark.parametrize("width", [3.0, 4.0, 6.0, 8.0, 12.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_blob_of_any_size_is_found_at_its_middle(width: float, sign: float) -> None:
    vertices, faces = SHEET
    assert meshdog(sign * bump(vertices, width, width), vertices, faces)[0] == MIDDLE


def test_one_colour_has_no_features() -> None:
    vertices, faces = SHEET
    assert meshdog(np.full(len(vertices), 42.0), vertices, faces).size == 0
    rounding = np.random.default_rng(0).uniform(0.0, 1e-12, len(vertices))
    assert meshdog(42.0 + rounding, vertices, faces).size == 0


def test_features_are_the_extrema_of_the_definition_where_these_are_few() -> None:
    scalar, vertices, faces = speckled(3)
    differences = differences_of_gaussians(scalar, vertices, one_rings(faces, len(vertices)))
    expected = extrema_by_definition(differences, faces)
    assert 10 < len(expected) < 100
    assert set(meshdog(scalar, vertices, faces).tolist()) == expected


def test_each_step_blurs_as_many_times_more_as_variances_add() -> None:
    vertices, faces = SHEET
    squares = (vertices[:, 0] - 60.0) ** 2  # each average adds the same constant to it
    differences = differences_of_gaussians(squares, vertices, one_rings(faces, len(vertices)))
    np.testing.assert_allclose(differences[:6, MIDDLE] / differences[0, MIDDLE], [1, 2, 3, 5, 7, 12])


@given(st.floats(-3.0, 3.0), st.floats(0.0, 3.0), st.floats(0.0, 7.0))
def test_corners_bend_to_one_side_and_at_most_ten_times_more_one_way(
    first: float, ratio: float, angle: float
) -> None:
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    for sign in (1.0, -1.0):
        hessian = turn @ np.diag([10.0**first, sign * 10.0 ** (first + ratio)]) @ turn.T
        expected = sign > 0 and ratio < 1.0
        if abs(ratio - 1.0) > 1e-6:
            assert are_corners(hessian[None])[0] == expected


def test_a_blob_is_a_corner_and_a_ridge_is_none() -> None:
    vertices, faces = SHEET
    operator, normals = gradient_operator(vertices, faces), vertex_normals(vertices, faces)
    for length, expected in [(10.0, True), (29.0, True), (35.0, False), (np.inf, False)]:
        hessians = tangent_hessians(operator, bump(vertices, 10.0, length), normals)
        assert are_corners(hessians[[MIDDLE]])[0] == expected  # the ratio is (length / width)²


def test_at_most_five_per_cent_of_the_vertices_are_features() -> None:
    scalar, vertices, faces = speckled(4)
    found = meshdog(scalar, vertices, faces)
    assert 100 <= len(found) <= 0.05 * len(vertices) + 1
    assert len(np.unique(found)) == len(found)


def test_streaks_fill_up_to_a_hundred_features() -> None:
    vertices, faces = SHEET
    noise = np.random.default_rng(0).standard_normal((61, 61))
    streaks = gaussian_filter1d(
        noise, 4.0, axis=1, mode="wrap"
    )  # four times as long as wide: hardly a corner
    assert len(meshdog(streaks.ravel(), vertices, faces)) == 100


@given(st.floats(1e-3, 1e3), st.floats(-1e3, 1e3))
def test_brightness_and_contrast_change_nothing(contrast: float, brightness: float) -> None:
    scalar, vertices, faces = speckled(3)
    found = meshdog(contrast * scalar + brightness, vertices, faces)
    np.testing.assert_array_equal(found, meshdog(scalar, vertices, faces))


@given(st.integers(0, 2**32 - 1))
def test_moving_the_mesh_changes_nothing(seed: int) -> None:
    scalar, vertices, faces = speckled(3)
    random = np.random.default_rng(seed)
    moved = Rotation.random(rng=random).apply(vertices) + random.uniform(-5.0, 5.0, 3)
    np.testing.assert_array_equal(meshdog(scalar, moved, faces), meshdog(scalar, vertices, faces))


@given(st.integers(0, 2**32 - 1))
def test_the_order_of_vertices_and_faces_changes_nothing(seed: int) -> None:
    scalar, vertices, faces = speckled(3)
    random = np.random.default_rng(seed)
    order = random.permutation(len(vertices))
    renumbered = np.argsort(order)[random.permutation(faces)]
    found = meshdog(scalar[order], vertices[order], renumbered)
    np.testing.assert_array_equal(order[found], meshdog(scalar, vertices, faces))


@pytest.fixture(scope="module", params=["mh_01_male_cauc_casual2", "q_animals__Cow"])
def surface(data_folder: Path, request: pytest.FixtureRequest) -> Surface:
    path = data_folder / "posed" / request.param / "pose_00.ply"
    mesh = read_mesh(Upload(files={path.name: path.read_bytes()}), Limits())
    return canonical_surface(mesh, repair(mesh), Parameters())


def test_real_surfaces_have_a_hundred_features_and_the_same_under_noise(surface: Surface) -> None:
    lightness = surface.lab[:, 0]
    found = meshdog(lightness, surface.vertices, surface.faces)
    assert 100 <= len(found) <= 250  # 5 % of 5 000
    noise = np.random.default_rng(0).normal(0.0, 0.25, len(lightness))
    again = meshdog(lightness + noise, surface.vertices, surface.faces)
    assert np.isin(found, again).mean() > 0.5
