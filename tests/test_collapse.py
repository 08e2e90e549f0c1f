import numpy as np

from tests.shapes import sheet, sphere
from worker.geometry.areas import face_vectors
from worker.geometry.collapse import collapse_short_edges
from worker.geometry.edges import find_edges, lengths_of


def test_a_sphere_stays_a_sphere_with_the_wanted_number_of_vertices() -> None:
    vertices, faces = collapse_short_edges(*sphere(4), 500)
    edges = find_edges(faces)
    assert len(vertices) == 500
    assert (edges.n_faces == 2).all()
    assert len(vertices) - len(edges.ends) + len(faces) == 2
    np.testing.assert_allclose(np.linalg.norm(vertices, axis=1), 1.0, atol=0.02)


def test_no_triangle_turns_over() -> None:
    vertices, faces = collapse_short_edges(*sphere(4), 300)
    outwards = np.sum(face_vectors(vertices, faces) * vertices[faces].mean(axis=1), axis=1)
    assert (outwards > 0).all()


def test_a_sheet_keeps_its_plane_its_outline_and_its_area() -> None:
    vertices, faces = collapse_short_edges(*sheet(30), 300)
    assert len(vertices) == 300
    np.testing.assert_allclose(vertices[:, 2], 0.0, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(face_vectors(vertices, faces), axis=1).sum(), 1.0, rtol=3e-3)


def test_vertices_are_spread_evenly() -> None:
    vertices, faces = collapse_short_edges(*sphere(5), 1_000)
    lengths = lengths_of(vertices, find_edges(faces))
    assert lengths.std() < 0.3 * lengths.mean()


def test_a_lone_triangle_stays() -> None:
    _, triangles = collapse_short_edges(np.eye(3), np.array([[0, 1, 2]]), 1)
    assert len(triangles) == 1


def test_a_tetrahedron_stays() -> None:
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    fewer, triangles = collapse_short_edges(vertices, faces, 2)
    assert len(fewer) == 4
    assert len(triangles) == 4


def test_two_triangles_that_meet_in_a_corner_stay() -> None:
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]])
    faces = np.array([[0, 1, 2], [0, 3, 4]])
    _, triangles = collapse_short_edges(vertices, faces, 1)
    assert len(triangles) == 2


def test_edges_over_the_longest_stay() -> None:
    given_vertices, given_faces = sphere(4)
    before = lengths_of(given_vertices, find_edges(given_faces))
    vertices, faces = collapse_short_edges(given_vertices, given_faces, 10, longest=1.3 * before.mean())
    assert len(vertices) > 0.2 * len(given_vertices)
    assert lengths_of(vertices, find_edges(faces)).min() > 1.3 * before.mean()


def test_what_is_very_fine_becomes_as_even_as_the_rest() -> None:
    vertices, faces = collapse_short_edges(*sphere(6), 1_000)  # more than MANY times as many
    lengths = lengths_of(vertices, find_edges(faces))
    assert len(vertices) == 1_000
    assert lengths.std() < 0.3 * lengths.mean()


def test_a_tunnel_stays_open() -> None:
    steps = 2 * np.pi * np.arange(40) / 40
    round_axis, round_ring = (angles.ravel() for angles in np.meshgrid(steps, steps, indexing="ij"))
    radius = 3.0 + np.cos(round_ring)
    vertices = np.column_stack([radius * np.cos(round_axis), radius * np.sin(round_axis), np.sin(round_ring)])
    here = np.arange(1600).reshape(40, 40)
    right, down = np.roll(here, -1, axis=1), np.roll(here, -1, axis=0)
    across = np.roll(down, -1, axis=1)
    corners = [np.stack([here, down, across], axis=-1), np.stack([here, across, right], axis=-1)]
    fewer, faces = collapse_short_edges(vertices, np.concatenate(corners).reshape(-1, 3), 60)
    edges = find_edges(faces)
    assert (edges.n_faces == 2).all()
    assert len(fewer) - len(edges.ends) + len(faces) == 0  # Euler
