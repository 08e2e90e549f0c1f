import numpy as np
from scipy.spatial.distance import cdist

from tests.shapes import sheet
from worker.geometry.cells import cell_means, cells_of, nearest_of, nearest_one_by_one


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


def test_the_nearest_is_the_nearest_in_all_coordinates_near_and_far() -> None:
    generator = np.random.default_rng(0)
    points, centres = 10 * generator.uniform(size=(500, 6)), 10 * generator.uniform(size=(400, 6))
    points[0] = 1e4  # far outside
    for reach in (0.5, 3.0, 30.0):
        found = nearest_of(points, centres, reach)
        np.testing.assert_array_equal(found, nearest_one_by_one(points, centres, reach))
        np.testing.assert_array_equal(found, cdist(points, centres).argmin(axis=1))
