"""Welds join what nearly touches, each by a handle, and leave the rest as it is."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from service.evaluation.contacts import AWAY, REACH, weld_contacts
from tests.mesh_files import area
from tests.shapes import coloured, sheet, sphere
from worker.arrays import FloatArray
from worker.geometry.edges import find_edges, lengths_of
from worker.geometry.repair import Repaired, repair
from worker.reading.mesh import Mesh

GAP = 0.03


def folded(n: int = 40) -> Mesh:
    """Return a sheet of 2 × 1, folded once; its two layers are a small gap apart."""
    vertices, faces = sheet(n, width=2.0)
    beyond = vertices[:, 0] > 1.0
    layers = np.where(beyond[:, None], [2.0, 0.0, GAP] + vertices * [-1.0, 1.0, 1.0], vertices)
    return coloured(layers, faces, np.clip(vertices / 2, 0, 1))


def seamed(mesh: Mesh) -> Mesh:
    """Split the vertices between the two halves of a mesh, as files do where an image ends."""
    right = mesh.vertices[mesh.faces].mean(axis=1)[:, 0] > mesh.vertices[:, 0].mean()
    corners = mesh.faces + len(mesh.vertices) * right[:, None]
    named, faces = np.unique(corners, return_inverse=True)
    return replace(mesh, vertices=np.vstack([mesh.vertices] * 2)[named], faces=faces.reshape(-1, 3))


def unit_of(mesh: Mesh) -> float:
    return float(np.sqrt(area(mesh.vertices, mesh.faces)))


def characteristic(repaired: Repaired) -> int:
    """Return V − E + F."""
    return len(repaired.vertices) - len(find_edges(repaired.faces).ends) + len(repaired.faces)


def along(mesh: Mesh) -> FloatArray:
    """Return distances along edges between all vertices (n, n); faces must share vertices."""
    edges = find_edges(mesh.faces)
    n = len(mesh.vertices)
    graph: sparse.csr_array = sparse.csr_array((lengths_of(mesh.vertices, edges), edges.ends.T), shape=(n, n))
    return np.asarray(dijkstra(graph, directed=False))


def welded(mesh: Mesh, strength: int, seed: int = 0) -> Mesh:
    return weld_contacts(mesh, strength, np.random.default_rng(seed))


def between(mesh: Mesh, first: FloatArray, second: FloatArray) -> float:
    """Return the shortest way along a mesh's edges from places (k, 3) to others."""
    lengths = along(mesh)
    ends = [cKDTree(mesh.vertices).query(places)[1] for places in (first, second)]
    return float(lengths[np.ix_(*ends)].min())


@pytest.mark.parametrize("strength", [1, 2, 3, 4, 5])
def test_each_weld_adds_a_handle(strength: int) -> None:
    for form in (folded(), seamed(folded())):
        repaired = repair(welded(form, strength))
        assert characteristic(repair(form)) == 1
        assert characteristic(repaired) == 1 - 2 * strength
        assert repaired.components == 1


def test_a_weld_is_part_of_the_surface_and_faces_as_it_does() -> None:
    (warning,) = repair(welded(folded(), 5)).warnings[1:]
    assert "the surface has a border" in warning


def test_a_weld_shortens_the_way_between_its_ends() -> None:
    mesh = folded()
    after = welded(mesh, 1)
    first, second = after.vertices[-6:].reshape(2, 3, 3)
    edge = 2 * np.sqrt(5) / 40
    assert between(mesh, first, second) > AWAY * unit_of(mesh) - 2 * edge
    assert between(repaired_mesh(after), first, second) <= REACH * unit_of(mesh)


def test_a_weld_wears_the_colours_of_its_ends() -> None:
    mesh = folded()
    after = welded(mesh, 5)
    tunnels = slice(-6 * 5, None)
    places = cKDTree(mesh.vertices).query(after.vertices[after.faces[tunnels]])[1]
    at_vertices = np.empty_like(mesh.vertices)
    at_vertices[mesh.faces] = mesh.corner_colours
    np.testing.assert_allclose(after.corner_colours[tunnels], at_vertices[places])


def test_two_triangles_give_way_to_six_and_the_rest_stays() -> None:
    mesh = folded()
    after = welded(mesh, 3)
    left = {tuple(face) for face in after.faces.tolist()}
    assert sum(tuple(face) not in left for face in mesh.faces.tolist()) == 2 * 3
    assert len(after.faces) == len(mesh.faces) + 3 * (6 - 2)
    np.testing.assert_array_equal(after.vertices[: len(mesh.vertices)], mesh.vertices)


def test_no_triangle_gives_way_twice_where_triangles_are_large() -> None:
    for n in (4, 5, 8):
        mesh = folded(n)
        after = welded(mesh, 5)
        welds = (len(after.vertices) - len(mesh.vertices)) // 6
        assert len(after.faces) == len(mesh.faces) + welds * (6 - 2)
        assert characteristic(repair(after)) == 1 - 2 * welds


@pytest.mark.parametrize("form", [lambda mesh: mesh, seamed])
def test_a_surface_that_touches_itself_nowhere_stays_as_it_is(form: Callable[[Mesh], Mesh]) -> None:
    vertices, faces = sphere(4)
    mesh = form(coloured(vertices, faces, (vertices + 1) / 2))
    for seed in range(3):
        np.testing.assert_array_equal(welded(mesh, 5, seed).faces, mesh.faces)


def repaired_mesh(mesh: Mesh) -> Mesh:
    """Return a mesh whose faces share vertices, without losing its place."""
    vertices, faces = np.unique(mesh.vertices, axis=0, return_inverse=True)
    return coloured(vertices, faces.reshape(-1)[mesh.faces], np.zeros_like(vertices))
