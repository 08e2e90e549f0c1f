"""Damage has the size that it says, where it says, and touches nothing else."""

import numpy as np
import pytest
from scipy.optimize import linprog

from service.evaluation.damage import BALL, HOLE, HOLES, PART, RED, SUNK, cut_away, punch_holes, stick_on_ball
from tests.evaluations import textured_box
from tests.mesh_files import area
from tests.shapes import coloured, icosahedron, sheet, sphere
from worker.arrays import BoolArray, FloatArray
from worker.geometry.areas import face_vectors
from worker.geometry.repair import repair
from worker.reading.mesh import Mesh

STRENGTHS = (1, 2, 3, 4, 5)


def ball(levels: int) -> Mesh:
    vertices, faces = sphere(levels)
    return coloured(vertices, faces, (vertices + 1) / 2)


def seeded(seed: int = 0) -> np.random.Generator:
    return np.random.default_rng(seed)


def surface(mesh: Mesh) -> float:
    return area(mesh.vertices, mesh.faces)


def kept_faces(mesh: Mesh, part: Mesh) -> BoolArray:
    """Return which of a mesh's faces are left; all of the part's must be among them."""
    left = set(map(tuple, part.faces.tolist()))
    kept = np.array([tuple(face) in left for face in mesh.faces.tolist()])
    assert kept.sum() == len(part.faces)
    return kept


def separable(points: FloatArray, others: FloatArray) -> bool:
    """Return whether a plane has all points on one side and all others on the other."""
    ahead = np.column_stack([-points, np.ones(len(points))])  # n · x − c ≥ 1
    behind = np.column_stack([others, -np.ones(len(others))])  # n · x − c ≤ −1
    sides = np.vstack([ahead, behind])
    found = linprog(np.zeros(4), A_ub=sides, b_ub=-np.ones(len(sides)), bounds=(None, None))
    return bool(found.status == 0)


@pytest.mark.parametrize("strength", STRENGTHS)
def test_holes_take_their_share_of_a_fine_surface(strength: int) -> None:
    mesh = ball(5)
    removed = [1 - surface(punch_holes(mesh, strength, seeded(seed))) / surface(mesh) for seed in range(5)]
    assert np.mean(removed) == pytest.approx(HOLES * strength * HOLE, rel=0.15)  # some overlap


def test_holes_are_round() -> None:
    vertices, faces = sheet(60)
    mesh = coloured(vertices, faces, vertices)
    kept = kept_faces(mesh, punch_holes(mesh, 1, seeded()))
    centres = mesh.vertices[faces].mean(axis=1)
    near = np.linalg.norm(centres[~kept][:, None] - centres, axis=2) <= np.sqrt(HOLE / np.pi)  # of area 1
    middles = ~(near & kept).any(axis=1)  # all around them is gone
    assert near[:, ~kept][:, middles].any(axis=1).all()
    assert 0 < middles.sum() <= HOLES


def test_a_coarse_mesh_has_no_triangle_as_small_as_a_hole() -> None:
    vertices, faces = icosahedron()
    mesh = coloured(vertices, faces, (vertices + 1) / 2)
    np.testing.assert_array_equal(punch_holes(mesh, 5, seeded()).faces, faces)


def test_holes_spare_large_triangles_among_small_ones() -> None:
    vertices, faces = sheet(60)
    flap = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.5, 0.01]])  # over the sheet, and large
    mesh = coloured(
        np.vstack([vertices, flap]),
        np.vstack([faces, len(vertices) + np.array([[0, 1, 2]])]),
        np.zeros((len(vertices) + 3, 3)),
    )
    for seed in range(5):
        kept = kept_faces(mesh, punch_holes(mesh, 5, seeded(seed)))
        assert kept[-1]
        assert not kept.all()


@pytest.mark.parametrize("strength", STRENGTHS)
def test_a_cut_removes_6_per_cent_for_each_strength_to_within_a_triangle(strength: int) -> None:
    mesh = ball(3)
    part = cut_away(mesh, strength, seeded(strength))
    missing = surface(mesh) - surface(part) - PART * strength * surface(mesh)
    largest = np.linalg.norm(face_vectors(mesh.vertices, mesh.faces), axis=1).max()
    assert -1e-9 <= missing <= largest


def test_what_is_cut_away_lies_beyond_a_plane() -> None:
    mesh = ball(3)
    centres = mesh.vertices[mesh.faces].mean(axis=1)
    for seed in range(3):
        kept = kept_faces(mesh, cut_away(mesh, 4, seeded(seed)))
        assert separable(centres[~kept], centres[kept])
    assert not separable(centres[::2], centres[1::2])


def test_directions_of_cuts_are_drawn() -> None:
    parts = [cut_away(ball(2), 3, seeded(seed)).faces for seed in (0, 0, 1)]
    np.testing.assert_array_equal(parts[0], parts[1])
    assert not np.array_equal(parts[0], parts[2])


def test_a_cut_never_takes_everything() -> None:
    mesh = coloured(np.eye(3), np.array([[0, 1, 2]]), np.zeros((3, 3)))
    assert len(cut_away(mesh, 5, seeded()).faces) == 1


@pytest.mark.parametrize("strength", STRENGTHS)
def test_the_ball_has_6_per_cent_of_the_area_for_each_strength(strength: int) -> None:
    mesh = ball(3)
    share = surface(stick_on_ball(mesh, strength, seeded())) / surface(mesh) - 1
    assert 0.99 * PART * strength < share < PART * strength


def test_the_ball_is_closed_red_and_turned_outwards() -> None:
    mesh = textured_box()
    with_ball = stick_on_ball(mesh, 2, seeded())
    corners, faces = with_ball.vertices[8:], with_ball.faces[12:] - 8
    assert len(corners) == BALL
    directed = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    assert set(map(tuple, directed.tolist())) == set(map(tuple, directed[:, ::-1].tolist()))
    assert len(np.unique(directed, axis=0)) == len(directed)  # each edge once in each direction
    outwards = np.einsum(
        "md,md->m", face_vectors(corners, faces), corners[faces].mean(axis=1) - corners.mean(axis=0)
    )
    assert (outwards > 0).all()
    assert (with_ball.corner_colours[12:] == RED).all()
    assert (with_ball.face_textures[12:] == -1).all()


def test_the_ball_sits_a_little_sunk_on_the_side_that_normals_point_to() -> None:
    vertices, faces = sheet(20)
    mesh = coloured(vertices, faces, vertices)
    corners = stick_on_ball(mesh, 1, seeded()).vertices[len(vertices) :]
    radius = np.sqrt(PART / (4 * np.pi))
    assert corners[:, 2].mean() == pytest.approx((1 - SUNK) * radius, rel=1e-3)
    assert corners[:, 2].min() == pytest.approx(-SUNK * radius, abs=0.01 * radius)


def test_the_ball_stands_where_there_is_area() -> None:
    vertices, faces = sheet(10)
    small = vertices * 1e-3 + [5.0, 0.0, 0.0]
    both = coloured(
        np.vstack([vertices, small]),
        np.vstack([faces, faces + len(vertices)]),
        np.zeros((2 * len(vertices), 3)),
    )
    for seed in range(5):
        assert stick_on_ball(both, 1, seeded(seed)).vertices[2 * len(vertices) :, 0].mean() < 2


def test_the_rest_of_the_mesh_is_as_it_was() -> None:
    mesh = textured_box()
    with_ball = stick_on_ball(mesh, 5, seeded())
    np.testing.assert_array_equal(with_ball.faces[:12], mesh.faces)
    np.testing.assert_array_equal(with_ball.corner_colours[:12], mesh.corner_colours)
    assert with_ball.textures is mesh.textures


def test_every_damage_leaves_a_mesh_that_can_be_repaired() -> None:
    for damage in (punch_holes, cut_away, stick_on_ball):
        assert len(repair(damage(ball(3), 5, seeded())).faces) > 500
