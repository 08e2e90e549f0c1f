"""Creatures are whole, bend without stretching much, and keep their colours when they bend."""

import numpy as np
import pytest
from scipy.spatial import KDTree

from service.samples.bodies.bird import bird
from service.samples.creatures import KINDS, make_creature, random_pose
from service.samples.flesh import Skin
from service.samples.palettes import COATS
from service.samples.proportions import Proportions
from service.samples.shell import vertex_normals
from service.samples.skeleton import move
from worker.arrays import FloatArray, IntArray


def _edge_lengths(vertices: FloatArray, faces: IntArray) -> FloatArray:
    ends = np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return np.asarray(np.linalg.norm(vertices[ends[:, 0]] - vertices[ends[:, 1]], axis=1))


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_a_creature_is_one_closed_surface(kind: str) -> None:
    shell = make_creature(kind, COATS["tiger"], n_vertices=3000)
    edges = np.sort(np.vstack([shell.faces[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
    assert 2400 < len(shell.vertices) < 3600


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_poses_are_nearly_isometric(kind: str) -> None:
    shell = make_creature(kind, COATS["tiger"], n_vertices=2000)
    skin = Skin(KINDS[kind].body(Proportions()))
    before, weights = _edge_lengths(shell.rest, shell.faces), skin.weights(shell.rest)
    for pose in KINDS[kind].poses.values():
        bent = move(skin.body, pose, shell.rest, weights)
        stretch = _edge_lengths(bent, shell.faces) / before
        assert np.mean(np.abs(np.log(stretch)) < 0.1) > 0.75
        assert _area(bent, shell.faces) == pytest.approx(_area(shell.rest, shell.faces), rel=0.05)


def test_colours_stick_to_the_body() -> None:
    poses = list(KINDS["grazer"].poses.values())
    first, second = (
        make_creature("grazer", COATS["savannah"], pose, n_vertices=n, offset=offset)
        for pose, n, offset in ((poses[0], 6000, 0.0), (poses[1], 5500, 0.4))
    )
    colours = [shell.paint(shell.rest, vertex_normals(shell.rest, shell.faces)) for shell in (first, second)]
    nearest = KDTree(second.rest).query(first.rest)[1]
    assert np.median(np.abs(colours[0] - colours[1][nearest])) < 0.02


def test_random_poses_name_real_joints_and_differ() -> None:
    first, second = (random_pose("bird", np.random.default_rng(seed)) for seed in (1, 2))
    assert first.keys() == {joint.name for joint in bird(Proportions()).joints}
    assert any(list(first[name]) != list(second[name]) for name in first)


def _area(vertices: FloatArray, faces: IntArray) -> float:
    a, b, c = (vertices[column] for column in faces.T)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)
