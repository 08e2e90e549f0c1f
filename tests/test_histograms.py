import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from worker.arrays import BoolArray, FloatArray
from worker.descriptors.histograms import join_bins, lab_histogram, look_up_cells
from worker.geometry.colour import srgb_to_lab
from worker.parameters import Parameters

LENGTHS = (100.0, 160.0, 160.0)  # of the ranges of L, a and b
LOWER = (0.0, -80.0, -80.0)
CHROMA = [-80, -40, -20, -10, 0, 10, 20, 40, 80]  # where cells meet
EDGES = (np.linspace(0.0, 100.0, 9), CHROMA, CHROMA)


def joined(lab: FloatArray) -> FloatArray:
    """Return the histogram that is compared."""
    parameters = Parameters()
    return join_bins(
        lab_histogram(lab, parameters.histogram_bins, parameters.histogram_smoothing),
        parameters.histogram_bins,
        parameters.histogram_lightness,
        parameters.histogram_chroma,
    )


@given(st.integers(0, 2**32 - 1))
def test_a_histogram_sums_to_1_whatever_the_colours(seed: int) -> None:
    srgb = np.random.default_rng(seed).choice([0.0, 0.3, 1.0], (50, 3))
    histogram = lab_histogram(srgb_to_lab(srgb), 16, 0.7)
    np.testing.assert_allclose(histogram.sum(), 1.0)
    assert (histogram >= 0).all()


def test_a_mixture_of_colours_is_the_mixture_of_histograms() -> None:
    red, blue = (
        np.tile(srgb_to_lab(np.array([colour])), (100, 1)) for colour in ([0.8, 0.3, 0.3], [0.3, 0.3, 0.7])
    )
    parts = [lab_histogram(lab, 16, 0.7) for lab in (red, blue)]
    mixed = lab_histogram(np.vstack([red, red, red, blue]), 16, 0.7)
    np.testing.assert_allclose(mixed, 0.75 * parts[0] + 0.25 * parts[1], atol=1e-3)


def test_distance_grows_with_the_difference_of_colours() -> None:
    base = np.tile([[50.0, 0.0, 0.0]], (100, 1))
    shifts = [0.0, 2.0, 5.0, 10.0, 30.0]
    distances = [
        np.abs(lab_histogram(base, 16, 0.7) - lab_histogram(base + [shift, 0, 0], 16, 0.7)).sum()
        for shift in shifts
    ]
    assert distances[0] == 0.0
    assert (np.diff(distances) > 0).all()
    np.testing.assert_allclose(distances[-1], 2.0, atol=0.1)  # nothing in common


def test_greys_do_not_jump_between_bins() -> None:
    grey = np.tile([[50.0, 1e-9, -1e-9]], (10, 1))
    np.testing.assert_allclose(
        lab_histogram(grey, 16, 0.7), lab_histogram(-grey * [-1, 1, 1], 16, 0.7), atol=1e-9
    )


def middles(axis: int) -> FloatArray:
    """Return the middles of 16 bins."""
    return np.asarray(LOWER[axis] + (np.arange(16) + 0.5) * LENGTHS[axis] / 16)


def spread(lab: FloatArray) -> FloatArray:
    """Share colours among 16³ bins by the tent that is 1 at a bin's middle and 0 at its neighbours'."""
    tents = []
    for axis in range(3):
        places = np.clip(lab[:, axis], middles(axis)[0], middles(axis)[-1])
        away = np.abs(places[:, None] - middles(axis)) / (LENGTHS[axis] / 16)
        tents.append(np.maximum(1.0 - away, 0.0))
    return np.asarray(np.einsum("ki,kj,kl->ijl", *tents, optimize=True))


def reached() -> BoolArray:
    """Tell which of 16³ bins any colour of sRGB is shared with, or lie beside one."""
    steps = np.linspace(0.0, 1.0, 33)
    filled = sum(
        spread(srgb_to_lab(np.stack(np.meshgrid(red, steps, steps), axis=-1).reshape(-1, 3))) for red in steps
    )
    padded = np.pad(np.asarray(filled) > 1e-12, 1)
    beside = [np.roll(padded, step, axis) for axis in range(3) for step in (-1, 1)]
    return np.asarray(np.logical_or.reduce([padded, *beside])[1:-1, 1:-1, 1:-1])


def smoothed(counts: FloatArray) -> FloatArray:
    """Smooth along each axis by the sum over neighbours up to two bins away; borders are mirrors."""
    for axis in range(3):
        weights = {step: np.exp(-(step**2) / (2 * 0.7**2)) for step in range(-2, 3)}
        padded = np.pad(counts, [(2, 2) if k == axis else (0, 0) for k in range(3)], mode="symmetric")
        shifted = [np.roll(padded, -step, axis) * weight for step, weight in weights.items()]
        total = np.sum(shifted, axis=0) / sum(weights.values())
        counts = np.take(total, range(2, 18), axis=axis)
    return counts


def cell_of(axis: int) -> list[int]:
    """Return the cell of each bin along an axis, by where its middle lies."""
    return [int(cell) - 1 for cell in np.digitize(middles(axis), EDGES[axis])]


def test_a_cell_holds_the_sum_of_its_fine_bins() -> None:
    colours = srgb_to_lab(np.random.default_rng(3).random((40, 3)))
    inside = reached()
    fine = np.where(inside, smoothed(spread(colours)), 0.0)
    cells, kept = np.zeros((8, 8, 8)), np.zeros((8, 8, 8), np.bool_)
    for place in np.argwhere(inside):
        cell = tuple(cell_of(axis)[k] for axis, k in enumerate(place))
        cells[cell] += fine[tuple(place)]
        kept[cell] = True
    found = joined(colours)
    assert len(found) == kept.sum() == 469
    np.testing.assert_allclose(found, cells[kept] / cells.sum(), atol=1e-12)
    np.testing.assert_allclose(found.sum(), 1.0)


def test_cells_of_one_bin_each_change_nothing() -> None:
    fine = lab_histogram(srgb_to_lab(np.random.default_rng(4).random((40, 3))), 16, 0.7)
    np.testing.assert_array_equal(join_bins(fine, 16, (1,) * 16, (1,) * 16), fine)


def test_joined_bins_tell_greys_apart_as_finely_as_before_and_strong_colours_less() -> None:
    def apart(lab: list[float], other: list[float]) -> tuple[float, float]:
        one, two = (np.array([colour]) for colour in (lab, other))
        fine = np.abs(lab_histogram(one, 16, 0.7) - lab_histogram(two, 16, 0.7)).sum()
        return float(np.abs(joined(one) - joined(two)).sum()), float(fine)

    joined_grey, fine_grey = apart([50.0, 0.0, 0.0], [50.0, 5.0, 0.0])
    joined_strong, fine_strong = apart([50.0, 60.0, 40.0], [50.0, 65.0, 40.0])
    assert joined_grey > 0.9 * fine_grey
    assert joined_strong < 0.6 * fine_strong


def test_looking_cells_up_is_the_transpose_of_filling_them() -> None:
    random = np.random.default_rng(6)
    lab, values = srgb_to_lab(random.random((30, 3))), random.random(469)
    ones = np.ones(469)
    parameters = Parameters()
    shape = (parameters.histogram_lightness, parameters.histogram_chroma)
    found = look_up_cells(values, lab, 16, 0.7, *shape)
    inside = look_up_cells(ones, lab, 16, 0.7, *shape)
    for place in range(30):
        np.testing.assert_allclose(found[place], inside[place] * (joined(lab[[place]]) @ values))


def test_areas_count_as_so_many_samples() -> None:
    lab = srgb_to_lab(np.random.default_rng(7).random((3, 3)))
    repeated = lab_histogram(lab[[0, 1, 1, 2, 2, 2]], 16, 0.7)
    np.testing.assert_allclose(lab_histogram(lab, 16, 0.7, np.array([1.0, 2.0, 3.0])), repeated)
