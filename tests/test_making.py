"""A recipe becomes the mesh that it says, the same each time."""

import numpy as np
import pytest

from service.evaluation.damage import BALL, RED, cut_away
from service.evaluation.making import coloured as colour_by
from service.evaluation.making import damaged, loses_part
from service.evaluation.photometric import recolour
from service.evaluation.protocol import BENT, PARTIAL, STRENGTHS, Geometry, Recipe, random_of
from service.evaluation.twins import make_twin
from tests.shapes import coloured, sphere
from tests.test_contacts import folded
from worker.reading.mesh import Mesh


def ball() -> Mesh:
    vertices, faces = sphere(4)
    return coloured(vertices, faces, (vertices + 3) / 6)


def geometry(damage: str, strength: int, model: str = "m") -> Geometry:
    return Geometry(model=model, source="m.ply", damage=damage, strength=strength)


WHOLE = geometry("whole", 0)


def test_what_is_not_damaged_stays_as_it_is() -> None:
    mesh = ball()
    assert damaged(mesh, WHOLE) is mesh
    assert colour_by(mesh, Recipe(geometry=WHOLE)) is mesh


@pytest.mark.parametrize("damage", [BENT, PARTIAL])
def test_the_same_geometry_is_damaged_alike_and_another_model_otherwise(damage: str) -> None:
    mesh = ball()
    first, again = (damaged(mesh, geometry(damage, 3)) for _ in range(2))
    np.testing.assert_array_equal(first.vertices, again.vertices)
    np.testing.assert_array_equal(first.faces, again.faces)
    others = [damaged(mesh, geometry(damage, 3, model)) for model in "abcdef"]
    sizes = {(len(part.faces), tuple(part.vertices[part.faces].mean(axis=(0, 1)))) for part in others}
    assert len(sizes) == 6


def test_a_bent_pose_has_welds_and_holes() -> None:
    mesh = folded()
    after = damaged(mesh, geometry(BENT, 2))
    assert len(after.vertices) == len(mesh.vertices) + 2 * 6
    left = {tuple(face) for face in after.faces.tolist()}
    assert sum(tuple(face) not in left for face in mesh.faces.tolist()) > 2 * 2  # more than welds take


def test_each_model_loses_a_part_and_carries_a_ball_in_turns() -> None:
    for model in "abc":
        lost = [loses_part(geometry(PARTIAL, strength, model)) for strength in STRENGTHS]
        assert lost in ([True, False] * 2 + [True], [False, True] * 2 + [False])
    halves = [loses_part(geometry(PARTIAL, 1, f"model {k}")) for k in range(400)]
    assert abs(np.mean(halves) - 0.5) < 0.1  # four standard errors


def test_partiality_is_a_cut_or_a_red_ball() -> None:
    mesh = ball()
    for strength in STRENGTHS:
        part = damaged(mesh, geometry(PARTIAL, strength))
        if loses_part(geometry(PARTIAL, strength)):
            expected = cut_away(mesh, strength, random_of("m", PARTIAL, strength))
            np.testing.assert_array_equal(part.faces, expected.faces)
        else:
            assert len(part.vertices) == len(mesh.vertices) + BALL
            assert (part.corner_colours[-1] == RED).all()


def test_changes_of_light_follow_one_another() -> None:
    mesh = ball()
    recipe = Recipe(geometry=WHOLE, changes=("noise", "hue"), strength=2, label="m/mixed")
    noisy = recolour(mesh, "noise", 2, random_of("m/mixed", 2, "noise"))
    expected = recolour(noisy, "hue", 2, random_of("m/mixed", 2, "hue"))
    np.testing.assert_array_equal(colour_by(mesh, recipe).corner_colours, expected.corner_colours)


def test_noise_differs_between_labels() -> None:
    noisy = [
        colour_by(ball(), Recipe(geometry=WHOLE, changes=("noise",), strength=1, label=label))
        for label in ("a/noise", "b/noise", "a/mixed")
    ]
    for k in range(3):
        assert not np.array_equal(noisy[k].corner_colours, noisy[k - 1].corner_colours)


def test_a_coat_is_put_on_before_the_light_changes() -> None:
    mesh = ball()
    recipe = Recipe(geometry=WHOLE, coat=1, changes=("hue",), strength=3, label="m/hue")
    expected = recolour(make_twin(mesh, "m", 1), "hue", 3, random_of("m/hue", 3, "hue"))
    np.testing.assert_array_equal(colour_by(mesh, recipe).corner_colours, expected.corner_colours)
