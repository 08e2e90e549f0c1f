from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.distance import cdist

from service.evaluation.damage import cut_away
from service.evaluation.photometric import recolour
from tests.landmarked import Marked, marked
from worker.arrays import FloatArray, SingleArray
from worker.canonical import canonical_surface
from worker.descriptors.colour_change import ColourChange, fit_change
from worker.descriptors.landmarks import LADDER, RUNGS, place_landmarks, rates_at
from worker.descriptors.registration import (
    COLOUR_UNIT,
    KEPT,
    SHIFTS,
    SOFTNESS,
    TURNS,
    Registration,
    register,
    register_all,
)
from worker.descriptors.signatures import heat_kernel_signatures, log_of
from worker.geometry.repair import repair
from worker.geometry.sampling import farthest_points
from worker.parameters import Parameters
from worker.reading.mesh import Mesh
from worker.reading.upload import Upload, read_mesh
from worker.solving import areas_of, solve_joint

Numbers = FloatArray | SingleArray
NEARLY = 0.01  # deviations: the root of what single precision leaves of squares
CHANGE = ColourChange(contrast=0.85, offset=12.0, saturation=0.7, tint=(6.0, -5.0))  # none is clipped


def residuals(found: Registration) -> FloatArray:
    """Return all that is left, without the price of the light."""
    return np.array([found.forwards, found.backwards, found.geometry, found.bending])


def together(query: Marked, shape: Marked) -> Registration:
    """Register a shape with a query."""
    return register(query.query(), shape.stored())


def trimmed(values: Numbers, shares: Numbers) -> float:
    """Average over the best KEPT share by the definition: the integral of the quantiles up to there."""
    order = np.argsort(values)
    ends = np.concatenate([[0.0], np.cumsum(shares[order] / shares.sum())])
    inside = np.clip(np.minimum(ends[1:], KEPT) - ends[:-1], 0.0, None)
    return float(inside @ values[order] / KEPT)


def slowly(query: Marked, shape: Marked) -> Registration:
    """Register by the definition, in double precision but for the colours, which `fit_change` is given."""
    own = rates_at(shape.ladder, 0)
    tried = [cdist(rates_at(query.ladder, shift), own) for shift in SHIFTS]
    geometry, distances = min(
        ((trimmed(d.min(axis=1), query.shares), d) for d in tried), key=lambda found: found[0]
    )
    matches = np.exp(-(distances**2) / (2 * SOFTNESS**2)) * shape.shares
    before = (matches @ shape.lab / matches.sum(axis=1, keepdims=True)).T.astype(np.float32)
    change = fit_change(before, query.lab.T, query.shares)
    for turn in range(TURNS + 1):
        changed = change.apply(shape.lab.T).T
        joint = np.hypot(distances, cdist(query.lab, changed) / COLOUR_UNIT)
        nearest = joint.argmin(axis=1)
        if turn < TURNS:
            trusted = (query.shares * np.exp(-joint.min(axis=1))).astype(np.float32)
            change = fit_change(shape.lab[nearest].T, query.lab.T, trusted)
    return Registration(
        forwards=trimmed(joint.min(axis=1), query.shares),
        backwards=trimmed(joint.min(axis=0), shape.shares),
        geometry=geometry,
        bending=float(query.shares @ distances[np.arange(len(nearest)), nearest]),
        change=change,
    )


def test_it_is_what_the_definition_says() -> None:
    errors = []
    for seed in range(40):
        query, shape = marked(seed, 40 + 2 * seed).relit(CHANGE), marked(seed + 1)
        found, expected = together(query, shape), slowly(query, shape)
        errors.append(np.abs(residuals(found) / residuals(expected) - 1.0).max())
    assert np.quantile(errors, 0.9) < 1e-4
    assert max(errors) < 0.03  # rounding turns near ties


@given(st.integers(0, 300))
def test_nothing_is_left_between_a_shape_and_itself(seed: int) -> None:
    shape = marked(seed)
    found = together(shape, shape)
    np.testing.assert_allclose(residuals(found), 0.0, atol=NEARLY)
    assert found.change.unusual() < 0.001
    assert found.distance() < 5 * NEARLY
    assert together(shape, marked(seed + 1)).distance() > 1.0


@pytest.mark.parametrize("seed", range(10))
def test_the_order_of_landmarks_does_not_matter(seed: int) -> None:
    random = np.random.default_rng(seed)
    query, shape = marked(seed).relit(CHANGE), marked(seed + 1)
    turned = together(query.of(random.permutation(128)), shape.of(random.permutation(128)))
    np.testing.assert_allclose(residuals(turned), residuals(together(query, shape)), rtol=1e-4)


@given(st.integers(0, 300))
def test_another_light_is_found_and_leaves_nearly_nothing(seed: int) -> None:
    shape = marked(seed)
    found = together(shape.relit(CHANGE), shape)
    np.testing.assert_allclose(residuals(found), 0.0, atol=0.05)
    np.testing.assert_allclose(found.change.apply(shape.lab.T), CHANGE.apply(shape.lab.T), atol=2.0)
    assert found.distance() < together(shape.relit(CHANGE), marked(seed + 1)).distance() / 5


@pytest.mark.parametrize("shift", SHIFTS)
def test_a_shape_of_another_size_fits_as_well(shift: int) -> None:
    found = together(marked(0, size=2.0 ** (shift / RUNGS)), marked(0))
    np.testing.assert_allclose(residuals(found), 0.0, atol=NEARLY)


@given(st.integers(0, 300))
def test_a_cut_shape_is_nearer_to_itself_than_to_its_twin_in_other_colours(seed: int) -> None:
    whole = marked(seed)
    twin = replace(whole, lab=marked(seed + 1).lab)
    order = np.random.default_rng(seed).permutation(128)
    kept = order[np.cumsum(whole.shares[order]) < 0.8]
    cut = whole.of(kept)
    own, other = together(cut, whole), together(cut, twin)
    assert own.forwards < NEARLY  # all that is left of it lies on the whole
    assert own.distance() < other.distance()


@given(st.integers(0, 300))
def test_rows_without_area_never_matter(seed: int) -> None:
    query, shape = marked(seed), marked(seed + 1)
    zeros = Marked(
        ladder=np.zeros((9, len(LADDER)), np.float32),
        lab=np.zeros((9, 3), np.float32),
        shares=np.zeros(9, np.float32),
    )

    def padded(these: Marked) -> Marked:
        parts = [np.concatenate([getattr(part, name) for part in (these, zeros)]) for name in vars(these)]
        return Marked(ladder=parts[0], lab=parts[1], shares=parts[2])

    assert together(padded(query), padded(shape)) == together(query, shape)


def test_shapes_that_have_nothing_in_common_give_numbers() -> None:
    shape = marked(0)
    far = replace(shape, ladder=shape.ladder * np.float32(50.0), lab=np.zeros_like(shape.lab))
    for found in (together(far, shape), together(shape, far)):
        assert np.isfinite(found.distance())
        assert found.distance() > 100.0


def test_shapes_registered_together_are_registered_as_alone() -> None:
    query, shapes = marked(0, 60).query(), [marked(seed) for seed in range(5)]
    packed = np.stack([shape.packed() for shape in shapes])
    alone = [register(query, shape.stored()) for shape in shapes]
    assert register_all(query, packed) == register_all(query, packed.reshape(5, -1)) == alone


def test_an_unusual_light_costs_where_nothing_else_does() -> None:
    found = Registration(forwards=0.0, backwards=0.0, geometry=0.0, bending=0.0, change=ColourChange())
    assert found.distance() == 0.0
    assert replace(found, change=CHANGE).distance() > 0.0


def landmarks_of(mesh: Mesh) -> Marked:
    """Describe a mesh's landmarks as an upload's are."""
    parameters = Parameters()
    surface = canonical_surface(mesh, repair(mesh), parameters)
    spectrum = solve_joint(surface.vertices, surface.faces, surface.lab, 0.0, parameters)
    points = farthest_points(surface.vertices, parameters.landmarks)
    heat = heat_kernel_signatures(spectrum.eigenvalues, spectrum.eigenfunctions[points], np.array(LADDER))
    areas = areas_of(surface.vertices, surface.faces)
    placed = place_landmarks(surface.vertices, points, areas, surface.lab, len(points)).astype(np.float32)
    return Marked(ladder=log_of(heat).astype(np.float32), lab=placed[:, :3], shares=placed[:, 3])


def test_a_real_pose_cut_and_relit_finds_its_model(data_folder: Path) -> None:
    def read(model: str, pose: str) -> Mesh:
        path = data_folder / "posed" / model / f"{pose}.ply"
        return read_mesh(Upload(files={path.name: path.read_bytes()}))

    models = ["Alpaca", "Cow", "Horse", "Horse_White", "ShibaInu"]
    stored = [landmarks_of(read(f"q_animals__{model}", "pose_00")) for model in models]
    random = np.random.default_rng(0)
    cut = cut_away(read("q_animals__Horse", "pose_03"), 2, random)
    query = landmarks_of(recolour(recolour(cut, "brightness-", 2, random), "saturation-", 2, random))
    distances = [together(query, shape).distance() for shape in stored]
    assert models[int(np.argmin(distances))] == "Horse"
