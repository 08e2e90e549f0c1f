import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from service.evaluation.photometric import lab_to_srgb
from worker.arrays import SingleArray
from worker.geometry.colour import srgb_to_lab
from worker.geometry.gamut import clip_to_gamut

ANY = arrays(np.float32, (3, 20), elements=st.floats(-130.0, 130.0, width=32))  # Lab, mostly impossible


def single(lab: object) -> SingleArray:
    """Return rows of L, a and b of colours (n, 3)."""
    return np.ascontiguousarray(np.asarray(lab, np.float32).T)


def test_every_colour_of_srgb_stays_as_it_is() -> None:
    steps = np.linspace(0.0, 1.0, 18)
    cube = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)
    lab = single(srgb_to_lab(cube))
    clipped, outside = clip_to_gamut(lab)
    assert not outside.any()
    np.testing.assert_array_equal(clipped, lab)


def test_other_colours_are_clipped_as_a_file_would_hold_them() -> None:
    lab = np.random.default_rng(0).uniform([-20, -120, -120], [130, 120, 120], (5000, 3))
    clipped, outside = clip_to_gamut(single(lab))
    held = srgb_to_lab(lab_to_srgb(lab))
    assert 0.5 < outside.mean() < 1.0
    np.testing.assert_allclose(clipped[:, outside].T, held[outside], atol=0.05)
    np.testing.assert_array_equal(clipped[:, ~outside].T, lab[~outside].astype(np.float32))


@given(ANY)
def test_what_was_clipped_once_is_inside(lab: SingleArray) -> None:
    once, _ = clip_to_gamut(lab)
    twice, outside = clip_to_gamut(once)
    assert not outside.any()
    np.testing.assert_array_equal(twice, once)


@given(ANY)
def test_colours_do_not_depend_on_one_another(lab: SingleArray) -> None:
    clipped, outside = clip_to_gamut(lab)
    for k in range(0, 20, 5):
        alone, out = clip_to_gamut(lab[:, k : k + 1])
        assert out[0] == outside[k]
        np.testing.assert_allclose(alone[:, 0], clipped[:, k], atol=1e-3)


def test_single_precision_stays_single() -> None:
    for lab in ([[50.0, 0.0, 0.0]], [[50.0, 200.0, 0.0]]):
        assert clip_to_gamut(single(lab))[0].dtype == np.float32
