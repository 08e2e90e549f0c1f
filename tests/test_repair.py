"""Repair changes what is broken and nothing else."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.mesh_files import area
from tests.shapes import icosahedron
from worker.arrays import FloatArray, IntArray
from worker.errors import Code, MeshError
from worker.geometry.repair import empty_faces, repair
from worker.geometry.welding import first_equal_rows, weld
from worker.reading.mesh import Colour, Mesh


def mesh(vertices: FloatArray, faces: IntArray) -> Mesh:
    return Mesh(
        vertices=vertices,
        faces=faces,
        corner_colours=np.zeros((len(faces), 3, 3)),
        corner_uvs=np.zeros((len(faces), 3, 2)),
        face_textures=np.full(len(faces), -1),
        textures=(),
        colour=Colour.NONE,
        warnings=(),
    )


BALL = mesh(*icosahedron())


def soup(ball: Mesh) -> Mesh:
    """Return the same surface with every face on its own vertices."""
    return mesh(ball.vertices[ball.faces].reshape(-1, 3), np.arange(ball.faces.size).reshape(-1, 3))


def test_a_sound_mesh_stays_as_it_is() -> None:
    repaired = repair(BALL)
    np.testing.assert_array_equal(repaired.faces, BALL.faces)
    np.testing.assert_allclose(repaired.vertices, BALL.vertices, atol=1e-15)
    assert repaired.components == 1
    assert repaired.warnings == ()


def test_a_soup_of_triangles_is_welded_into_one_piece() -> None:
    repaired = repair(soup(BALL))
    assert repaired.components == 1
    assert len(repaired.vertices) == 12
    assert repaired.warnings == ("48 vertices at the position of another were joined with it",)


@pytest.mark.parametrize("offset", [0.0, 1e9, -4e6])
def test_a_shape_far_from_the_origin_keeps_its_area(offset: float) -> None:
    far = replace(BALL, vertices=np.round(BALL.vertices * 1024) + offset)
    near = np.round(BALL.vertices * 1024)
    repaired = repair(far)
    assert area(repaired.vertices, repaired.faces) == pytest.approx(area(near, BALL.faces), rel=1e-12)
    assert np.abs(repaired.vertices.mean(axis=0)).max() < 1e-3


@given(
    st.lists(st.sampled_from([-1.0, -0.0, 0.0, 1e-300, 1.0]), min_size=3, max_size=30).map(
        lambda x: x[: len(x) // 3 * 3]
    )
)
def test_vertices_weld_where_and_only_where_they_are_equal(numbers: list[float]) -> None:
    vertices = np.array(numbers).reshape(-1, 3)
    expected = [min(j for j in range(len(vertices)) if (vertices[j] == row).all()) for row in vertices]
    assert weld(vertices).tolist() == expected


@given(st.lists(st.tuples(st.integers(0, 2), st.integers(0, 2)), min_size=1, max_size=20))
def test_the_first_of_equal_rows_is_named(rows: list[tuple[int, int]]) -> None:
    assert first_equal_rows(np.array(rows)).tolist() == [rows.index(row) for row in rows]


def test_double_empty_and_loose_parts_are_dropped_and_counted() -> None:
    vertices = np.concatenate([BALL.vertices, [[9.0, 9, 9]], [BALL.vertices[:2].mean(axis=0)]])
    a, b, c = BALL.faces[0]
    edge = [BALL.faces[BALL.faces[:, 0] == 0][0][0], 1]
    faces = np.concatenate([BALL.faces, [[b, c, a], [c, b, a], [a, a, b], [*edge, 13]]])
    repaired = repair(mesh(vertices, faces))
    np.testing.assert_array_equal(repaired.source_faces, np.arange(20))
    assert len(repaired.vertices) == 12
    assert repaired.warnings == (
        "2 faces without area were dropped",
        "2 double faces were dropped",
        "2 vertices that no face uses were dropped",
    )


def test_turned_faces_say_which_corner_of_the_file_each_corner_is() -> None:
    faces = BALL.faces.copy()
    faces[[3, 5]] = faces[[3, 5]][:, [0, 2, 1]]
    repaired = repair(replace(BALL, faces=faces))
    np.testing.assert_array_equal(repaired.faces, BALL.faces)
    in_file = np.take_along_axis(faces[repaired.source_faces], repaired.source_corners, axis=1)
    np.testing.assert_array_equal(in_file, repaired.faces)
    assert repaired.warnings == ("2 faces were turned to face as their neighbours do",)


def test_every_piece_is_kept_and_counted() -> None:
    vertices = np.concatenate([BALL.vertices + 5 * step for step in range(3)])
    repaired = repair(mesh(vertices, np.concatenate([BALL.faces + 12 * step for step in range(3)])))
    assert repaired.components == 3
    assert len(repaired.faces) == 60
    assert repaired.warnings == ("the mesh is in 3 pieces",)


def test_open_and_branching_edges_are_counted() -> None:
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1]])
    repaired = repair(mesh(vertices, np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]])))
    assert "1 edges are shared by more than two faces" in repaired.warnings
    assert "6 edges are open: the surface has a border" in repaired.warnings


@pytest.mark.parametrize(
    ("vertices", "code"),
    [(np.ones((12, 3)), Code.ZERO_AREA), (np.outer(np.arange(12.0), [1, 2, 3]), Code.ZERO_AREA)],
)
def test_a_mesh_without_area_is_refused(vertices: FloatArray, code: Code) -> None:
    with pytest.raises(MeshError) as caught:
        repair(replace(BALL, vertices=vertices))
    assert caught.value.code == code


def test_a_mesh_without_faces_is_refused() -> None:
    with pytest.raises(MeshError) as caught:
        repair(mesh(BALL.vertices, np.zeros((0, 3), dtype=np.int64)))
    assert caught.value.code == Code.NO_FACES


@pytest.mark.parametrize("scale", [1e-30, 1.0, 1e30])
def test_a_thin_triangle_is_no_empty_one_at_any_scale(scale: float) -> None:
    vertices = scale * np.array([[0.0, 0, 0], [1, 0, 0], [0.5, 1e-6, 0], [0.25, 0, 0]])
    assert empty_faces(vertices, np.array([[0, 1, 2], [0, 1, 3]])).tolist() == [False, True]
