import numpy as np

from tests.shapes import SQUARE, sheet, sphere
from worker.arrays import FloatArray, IntArray
from worker.geometry.areas import edge_lengths, triangle_areas, vertex_areas
from worker.geometry.rings import one_rings, rings_covering


def areas_of(vertices: FloatArray, faces: IntArray) -> FloatArray:
    return vertex_areas(faces, triangle_areas(edge_lengths(vertices, faces)), len(vertices))


def rings_by_walking(faces: IntArray, areas: FloatArray, centre: int, area: float) -> set[int]:
    """Take rings as the definition says."""
    members = {centre}
    while True:
        more = members | {v for face in faces.tolist() if members & set(face) for v in face}
        if areas[list(more)].sum() >= area or more == members:
            return more
        members = more


def test_a_square_knows_its_neighbours_and_itself() -> None:
    expected = [[1, 1, 1, 1], [1, 1, 1, 0], [1, 1, 1, 1], [1, 0, 1, 1]]
    np.testing.assert_array_equal(one_rings(SQUARE, 4).toarray(), expected)


def test_rings_are_those_of_the_definition() -> None:
    vertices, faces = sphere(3)
    areas, centres = areas_of(vertices, faces), np.array([600, 0, 77, 77])
    owners, members = rings_covering(one_rings(faces, len(vertices)), areas, centres, 0.05 * areas.sum())
    for owner, centre in enumerate(centres):
        expected = rings_by_walking(faces, areas, int(centre), 0.05 * areas.sum())
        assert sorted(members[owners == owner].tolist()) == sorted(expected)


def test_an_area_larger_than_the_piece_takes_the_piece() -> None:
    vertices, faces = sheet(4)
    two, apart = np.vstack([vertices, vertices + 9.0]), np.vstack([faces, faces + len(vertices)])
    owners, members = rings_covering(one_rings(apart, len(two)), areas_of(two, apart), np.array([30]), 99.0)
    assert sorted(members.tolist()) == list(range(25, 50))
    assert (owners == 0).all()


def test_one_ring_is_taken_however_small_the_area() -> None:
    vertices, faces = sheet(4)
    _, members = rings_covering(one_rings(faces, 25), areas_of(vertices, faces), np.array([12]), 0.0)
    assert len(members) == 7


def test_no_centre_has_no_rings() -> None:
    vertices, faces = sheet(2)
    found = rings_covering(one_rings(faces, 9), areas_of(vertices, faces), np.empty(0, np.int64), 1.0)
    assert [len(part) for part in found] == [0, 0]
