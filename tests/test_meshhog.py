from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.distance import cdist
from scipy.spatial.transform import Rotation

from tests.shapes import sheet, sphere
from worker.arrays import FloatArray, IntArray
from worker.canonical import canonical_surface
from worker.descriptors.meshdog import meshdog
from worker.descriptors.meshhog import mesh_features, meshhog
from worker.geometry.repair import repair
from worker.parameters import Parameters
from worker.reading.limits import Limits
from worker.reading.upload import Upload, read_mesh

INDICES = np.arange(0, 642, 50)


def waves(points: FloatArray, seed: int = 0) -> FloatArray:
    """Add five smooth waves of random direction."""
    random = np.random.default_rng(seed)
    directions, phases = random.normal(0.0, 4.0, (5, 3)), random.uniform(0.0, 7.0, 5)
    return np.asarray(50.0 + 10.0 * np.sin(points @ directions.T + phases).sum(axis=1))


def waved_sphere() -> tuple[FloatArray, FloatArray, IntArray]:
    vertices, faces = sphere(3)
    return waves(vertices), vertices, faces


def planes(descriptors: FloatArray) -> FloatArray:
    """Unfold descriptors; (f, plane, slice, orientation)."""
    return descriptors.reshape(-1, 3, 4, 8)


def test_descriptors_are_unit_vectors_of_96_shares() -> None:
    found = meshhog(*waved_sphere(), INDICES)
    assert found.shape == (len(INDICES), 96)
    assert (found >= 0).all()
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1.0)


@pytest.mark.parametrize("angle", [0.0, 0.4, 2.0, 4.5])
def test_a_slope_on_a_plane_points_along_the_tangent_in_every_slice(angle: float) -> None:
    vertices, faces = sheet(40)
    slope = vertices @ [np.cos(angle), np.sin(angle), 0.0]
    found = planes(meshhog(slope, vertices, faces, np.array([20 * 41 + 20])))[0]
    np.testing.assert_allclose(found[0, :, 1:], 0.0, atol=1e-9)  # tangent and binormal: only orientation 0
    assert (found[0, :, 0] > 0.2).all()
    np.testing.assert_allclose(found[1], 0.0, atol=1e-9)  # binormal and normal: no slope
    np.testing.assert_allclose(found[2][[0, 2]], 0.0, atol=1e-9)  # normal and tangent: no place up or down,
    np.testing.assert_allclose(found[2][:, [0, 1, 3, 4, 5, 6, 7]], 0.0, atol=1e-9)  # only a quarter turn
    np.testing.assert_allclose(found[2][1, 2], found[2][3, 2])


def test_a_cone_points_inwards_on_all_sides() -> None:
    vertices, faces = sheet(40)
    cone = 1.0 - np.hypot(vertices[:, 0] - 0.5, vertices[:, 1] - 0.5)
    found = planes(meshhog(cone, vertices, faces, np.array([20 * 41 + 20])))[0, 0]
    inwards = [4, 6, 0, 2]  # half a turn from the slice's own direction
    np.testing.assert_array_equal(found.argmax(axis=1), inwards)


def test_one_colour_gives_no_numbers_and_no_features() -> None:
    vertices, faces = sphere(3)
    grey = np.full(len(vertices), 42.0)
    np.testing.assert_array_equal(meshhog(grey, vertices, faces, INDICES), np.zeros((len(INDICES), 96)))
    assert mesh_features(grey, vertices, faces).shape == (0, 96)


def test_features_whose_support_has_one_colour_are_left_out() -> None:
    vertices, faces = sheet(60)
    disc = np.where(np.hypot(vertices[:, 0] - 0.5, vertices[:, 1] - 0.5) < 0.15, 50.0, 0.0)
    indices = meshdog(disc, vertices, faces)
    found = meshhog(disc, vertices, faces, indices)
    middle = indices == 30 * 61 + 30
    assert middle.any()
    assert not found[middle].any()
    kept = mesh_features(disc, vertices, faces)
    assert len(kept) == np.count_nonzero(found.any(axis=1))
    np.testing.assert_allclose(np.linalg.norm(kept, axis=1), 1.0)


@given(st.integers(0, 2**32 - 1), st.floats(0.1, 10.0))
def test_moving_and_scaling_the_mesh_changes_nothing(seed: int, scale: float) -> None:
    scalar, vertices, faces = waved_sphere()
    random = np.random.default_rng(seed)
    moved = scale * Rotation.random(rng=random).apply(vertices) + random.uniform(-5.0, 5.0, 3)
    found = meshhog(scalar, moved, faces, INDICES)
    np.testing.assert_allclose(found, meshhog(scalar, vertices, faces, INDICES), atol=1e-9)


@given(st.integers(0, 2**32 - 1))
def test_the_order_of_vertices_and_faces_changes_nothing(seed: int) -> None:
    scalar, vertices, faces = waved_sphere()
    random = np.random.default_rng(seed)
    order = random.permutation(len(vertices))
    places = np.argsort(order)
    renumbered = np.roll(places[random.permutation(faces)], 1, axis=1)
    found = meshhog(scalar[order], vertices[order], renumbered, places[INDICES])
    np.testing.assert_allclose(found, meshhog(scalar, vertices, faces, INDICES), atol=1e-9)


@given(st.floats(1e-3, 1e3), st.floats(-1e3, 1e3))
def test_brightness_and_contrast_change_nothing(contrast: float, brightness: float) -> None:
    scalar, vertices, faces = waved_sphere()
    found = meshhog(contrast * scalar + brightness, vertices, faces, INDICES)
    np.testing.assert_allclose(found, meshhog(scalar, vertices, faces, INDICES), atol=1e-6)


def test_a_pattern_keeps_its_descriptor_elsewhere_on_a_sphere() -> None:
    vertices, faces = sphere(4)
    centre = vertices[1000]
    turned = Rotation.align_vectors(vertices[2000][None], centre[None])[0]
    distances = []
    for seed in range(10):
        here = meshhog(waves(vertices, seed), vertices, faces, np.array([1000]))
        there = meshhog(waves(turned.inv().apply(vertices), seed), vertices, faces, np.array([2000]))
        other = meshhog(waves(vertices, seed + 1), vertices, faces, np.array([1000]))
        distances.append([np.linalg.norm(here - there), np.linalg.norm(here - other)])
    same, different = np.transpose(distances)
    assert same.max() < different.min()
    assert np.median(same) < 0.1 * np.median(different)


def features_of(path: Path) -> FloatArray:
    mesh = read_mesh(Upload(files={path.name: path.read_bytes()}), Limits())
    surface = canonical_surface(mesh, repair(mesh), Parameters())
    return mesh_features(surface.lab[:, 0], surface.vertices, surface.faces)


def test_features_of_a_pose_have_their_nearest_in_their_own_model(data_folder: Path) -> None:
    folders = [data_folder / "posed" / model for model in ("mh_01_male_cauc_casual2", "q_fish__Shark")]
    rest = [features_of(folder / "pose_00.ply") for folder in folders]
    assert all(100 <= len(features) <= 2_000 for features in rest)
    for own, folder in enumerate(folders):
        distances = [cdist(features_of(folder / "pose_01.ply"), features) for features in rest]
        nearest = np.argmin([matrix.min(axis=1) for matrix in distances], axis=0)
        assert np.mean(nearest == own) > 0.7
