import numpy as np

from tests.shapes import sheet
from worker.geometry.cells import cell_means, cells_of


def test_the_two_sides_of_a_thin_wall_keep_their_colours() -> None:
    vertices, _ = sheet(10)
    up, down = np.tile([0.0, 0, 1], (121, 1)), np.tile([0.0, 0, -1], (121, 1))
    points = np.vstack([vertices + [0.02, 0.02, 0], vertices + [0.02, 0.02, -0.001]])
    values = np.vstack([np.ones((121, 1)), np.zeros((121, 1))])
    centres = np.vstack([vertices, vertices - [0, 0, 0.001]])
    sides = np.vstack([up, down])
    means = cell_means(values, cells_of(points, sides, centres, sides, turn=0.1))
    np.testing.assert_array_equal(means, values)


def test_a_cell_without_samples_takes_the_nearest_colour() -> None:
    centres = np.array([[0.0, 0, 0], [1, 0, 0], [5, 0, 0]])
    normals = np.tile([0.0, 0, 1], (3, 1))
    cells = cells_of(centres[:2], normals[:2], centres, normals, turn=1.0)
    means = cell_means(np.array([[1.0], [2.0]]), cells)
    np.testing.assert_array_equal(means, [[1.0], [2.0], [2.0]])
