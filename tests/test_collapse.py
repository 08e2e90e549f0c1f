import numpy as np

from tests.shapes import sheet, sphere
from worker.geometry.areas import face_vectors
from worker.geometry.collapse import _ascending, _common_neighbours, _quadrics, collapse_short_edges
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


def test_planes_of_a_vertex_meet_in_it() -> None:
    vertices, faces = sphere(2)
    equations = _quadrics(vertices, faces)
    points = np.linalg.solve(equations[:, :, :3], equations[:, :, 3:])[:, :, 0]
    np.testing.assert_allclose(points, vertices, atol=1e-9)


def test_common_neighbours_are_those_of_both_ends() -> None:
    _, faces = sphere(1)
    ends = find_edges(faces).ends
    around = [set(ends[(ends == vertex).any(axis=1)].ravel()) - {vertex} for vertex in range(faces.max() + 1)]
    pairs = ends[[0]]
    owners, common = _common_neighbours(ends, pairs, len(around))
    assert set(common) == around[pairs[0, 0]] & around[pairs[0, 1]]
    np.testing.assert_array_equal(owners, 0)


def test_of_equal_costs_the_first_comes_first() -> None:
    np.testing.assert_array_equal(_ascending(np.array([2.0, 1.0, np.inf, 1.0, 0.5])), [4, 1, 3, 0, 2])
