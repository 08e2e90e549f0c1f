from pathlib import Path

import numpy as np
import pytest
from scipy import linalg

from service.samples.variety import random_creature
from tests.shapes import sphere
from worker.arrays import FloatArray, IntArray
from worker.canonical import canonical_surface
from worker.geometry.repair import repair
from worker.parameters import Operator, Parameters
from worker.reading.upload import Upload, read_mesh
from worker.solving import operator_of, solve_joint


@pytest.mark.parametrize("operator", Operator)
@pytest.mark.parametrize("number", [0, 5, 6, 7])  # a creature, things, a box with pictures
def test_pairs_found_are_as_many_as_a_dense_solver_finds(number: int, operator: Operator) -> None:
    mesh = read_mesh(Upload(files=random_creature(number, 2011).files))
    parameters = Parameters(vertices=900, operator=operator)
    surface = canonical_surface(mesh, repair(mesh), parameters)
    arrays = surface.vertices, surface.faces, surface.lab
    for weight, cutoff in ((0.0, parameters.fine_cutoff), (0.2, parameters.cutoff)):
        found = solve_joint(*arrays, weight, parameters).eigenvalues
        stiffness, mass = operator_of(*arrays, weight, parameters)
        scale = 1 / np.sqrt(mass)
        expected = linalg.eigvalsh(scale[:, None] * stiffness.toarray() * scale)
        assert len(found) == np.count_nonzero(expected < cutoff)
        np.testing.assert_allclose(found, expected[: len(found)], rtol=1e-6, atol=1e-9)


def sphere_of_area(levels: int) -> tuple[FloatArray, IntArray, FloatArray]:
    """Return vertices and faces of a sphere of the canonical area, without colours."""
    vertices, faces = sphere(levels)
    return vertices * np.sqrt(19_000 / (4 * np.pi)), faces, np.zeros_like(vertices)


@pytest.mark.parametrize("size", [1e-3, 1e-5, 1e-6, 1e-7, 3e-8])
def test_a_vertex_of_almost_no_area_hides_no_pairs(size: float) -> None:
    vertices, faces, _ = sphere_of_area(3)
    a, b, c = faces[0]
    corners = vertices[[a, b, c]]
    middle = corners.mean(axis=0)
    n = len(vertices)
    vertices = np.vstack([vertices, middle + size * (corners - middle), middle])
    p, q, r, s = range(n, n + 4)
    ring = [(a, b, q), (a, q, p), (b, c, r), (b, r, q), (c, a, p), (c, p, r)]
    faces = np.vstack([faces[1:], ring, [(p, q, s), (q, r, s), (r, p, s)]])
    arrays = vertices, faces, np.zeros_like(vertices)
    found = solve_joint(*arrays, 0.0, Parameters()).eigenvalues
    plain = solve_joint(*sphere_of_area(3), 0.0, Parameters()).eigenvalues
    np.testing.assert_allclose(found, plain, rtol=5e-3, atol=1e-9)


def test_a_quilt_with_a_vertex_of_almost_no_area_is_solved(data_folder: Path) -> None:
    path = data_folder / "clutter" / "aws_house_Quilt_01_aws_Quilt_01_visual.ply"
    mesh = read_mesh(Upload(files={path.name: path.read_bytes()}))
    surface = canonical_surface(mesh, repair(mesh), Parameters())
    found = solve_joint(surface.vertices, surface.faces, surface.lab, 0.0, Parameters())
    assert len(found.eigenvalues) == 73  # as a dense solver counts
