import numpy as np
import pytest

from tests.shapes import sphere
from worker.arrays import FloatArray, IntArray
from worker.descriptors.landmarks import (
    LADDER,
    LONGER,
    RUNGS,
    SHORTER,
    SPREADS,
    WIDTH,
    log_heat_ladder,
    pack,
    place_landmarks,
    present,
    rates_at,
    unpack,
)
from worker.descriptors.signatures import heat_kernel_signatures, log_differences
from worker.geometry.areas import edge_lengths, triangle_areas, vertex_areas
from worker.geometry.laplacian import cotangent_laplacian
from worker.geometry.sampling import farthest_points
from worker.geometry.spectrum import solve_eigenpairs
from worker.parameters import Parameters

SHIFTS = range(-SHORTER, LONGER + 1)
OCTAVES = slice(SHORTER, -LONGER, RUNGS)  # of LADDER, without a shift


def ladder_of(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Return log h_t of every vertex at the times of LADDER, from all eigenpairs."""
    stiffness, mass = cotangent_laplacian(vertices, faces)
    pairs = solve_eigenpairs(vertices, stiffness, mass, np.inf, most=len(vertices))
    return np.log(heat_kernel_signatures(pairs.eigenvalues, pairs.eigenfunctions, np.array(LADDER)))


def egg() -> tuple[FloatArray, IntArray]:
    """Return an ellipsoid of about the canonical size, none of whose sides is like another."""
    vertices, faces = sphere(2)
    return vertices * [60.0, 40.0, 25.0], faces


@pytest.fixture(scope="module")
def ladder() -> FloatArray:
    return ladder_of(*egg())


def placed(n_points: int, n_rows: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return landmarks of an egg with random colours, and the colours and areas of its vertices."""
    vertices, faces = egg()
    areas = vertex_areas(faces, triangle_areas(edge_lengths(vertices, faces)), len(vertices))
    lab = np.random.default_rng(0).uniform([0, -80, -80], [100, 80, 80], (len(vertices), 3))
    points = farthest_points(vertices, n_points)
    return place_landmarks(vertices, points, areas, lab, n_rows), lab, areas


@pytest.mark.parametrize("shift", SHIFTS)
def test_a_surface_of_another_size_has_the_same_rates_at_times_shifted_as_its_area(
    ladder: FloatArray, shift: int
) -> None:
    vertices, faces = egg()
    larger = ladder_of(vertices * 2.0 ** (shift / RUNGS / 2), faces)  # h_ct = h_t / c
    np.testing.assert_allclose(rates_at(larger, shift), rates_at(ladder, 0), atol=1e-4)
    if shift:
        assert np.abs(rates_at(larger, 0) - rates_at(ladder, 0)).mean() > 0.01


@pytest.mark.parametrize("shift", SHIFTS)
def test_on_an_endless_plane_heat_halves_from_octave_to_octave(shift: int) -> None:
    ladder = -np.log(4.0 * np.pi * np.array(LADDER))[None]  # h_t = 1 / 4πt
    np.testing.assert_allclose(rates_at(ladder, shift), [-np.log(2.0) / SPREADS], rtol=1e-5)


def test_without_a_shift_rates_are_the_log_differences_of_signatures(ladder: FloatArray) -> None:
    np.testing.assert_allclose(LADDER[OCTAVES], Parameters().fine_times)
    signatures = np.exp(ladder[:, OCTAVES])
    np.testing.assert_allclose(rates_at(ladder, 0), log_differences(signatures) / SPREADS, atol=1e-5)


def test_landmarks_share_the_area_and_keep_its_mean_colour() -> None:
    rows, lab, areas = placed(20, 20)
    colours, shares = rows[:, :3], rows[:, 3]
    assert (shares > 0).all()
    assert shares.sum() == pytest.approx(1.0)
    np.testing.assert_allclose(shares @ colours, areas @ lab / areas.sum())


def test_a_landmark_at_every_vertex_has_its_area_and_colour() -> None:
    rows, lab, areas = placed(162, 162)
    points = farthest_points(egg()[0], 162)
    np.testing.assert_allclose(rows[:, :3], lab[points])
    np.testing.assert_allclose(rows[:, 3], (areas / areas.sum())[points])


def test_what_is_packed_comes_back_in_single_precision(ladder: FloatArray) -> None:
    rows, _, _ = placed(162, 162)
    packed = pack(ladder, rows)
    assert packed.shape == (162, WIDTH)
    single = packed.astype(np.float32)
    for sent in (single, single.ravel()):
        landmarks = unpack(sent)
        np.testing.assert_array_equal(landmarks.rates.T, rates_at(ladder, 0))
        np.testing.assert_array_equal(landmarks.lab.T, rows[:, :3].astype(np.float32))
        np.testing.assert_array_equal(landmarks.shares, rows[:, 3].astype(np.float32))


def test_a_small_mesh_has_rows_of_zeros_that_drop_out(ladder: FloatArray) -> None:
    points = farthest_points(egg()[0], 20)
    few = log_heat_ladder(ladder[points], 20)
    filled = log_heat_ladder(ladder[points], 32)
    assert filled.shape == (32, len(LADDER))
    assert not filled[20:].any()
    rows, _, _ = placed(20, 32)
    assert not rows[20:].any()
    packed = pack(filled, rows).astype(np.float32)
    assert not packed[20:].any()
    np.testing.assert_array_equal(present(packed), np.arange(32) < 20)
    found, expected = unpack(packed), unpack(pack(few, placed(20, 20)[0]).astype(np.float32))
    for name in ("rates", "lab", "shares"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name))
