import numpy as np
import pytest
from scipy import linalg

from service.samples.variety import random_creature
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
