from dataclasses import fields

import numpy as np

from service.evaluation.joining import append, painted, select_faces
from tests.evaluations import textured_box
from tests.shapes import box, coloured, icosahedron
from worker.reading.mesh import Mesh

PER_FACE = ("faces", "corner_colours", "corner_uvs", "face_textures")


def red_triangle(mesh: Mesh) -> Mesh:
    corners = np.array([[5.0, 0, 0], [6, 0, 0], [5, 1, 0]])
    colours = np.broadcast_to(np.array([1.0, 0, 0]), (1, 3, 3))
    return painted(mesh, corners, np.array([[0, 1, 2]]), colours)


def test_chosen_faces_keep_their_colours_and_everything_else_stays() -> None:
    mesh = textured_box()
    kept = np.arange(12) % 3 > 0
    part = select_faces(mesh, kept)
    for field in fields(Mesh):
        before, after = getattr(mesh, field.name), getattr(part, field.name)
        if field.name in PER_FACE:
            np.testing.assert_array_equal(after, before[kept])
        else:
            assert after is before


def test_what_is_appended_leaves_the_first_mesh_as_it_was() -> None:
    mesh = textured_box()
    both = append(mesh, red_triangle(mesh))
    np.testing.assert_array_equal(both.vertices[:8], mesh.vertices)
    for name in PER_FACE:
        np.testing.assert_array_equal(getattr(both, name)[:12], getattr(mesh, name))
    for name in ("textures", "colour", "warnings"):
        assert getattr(both, name) is getattr(mesh, name)


def test_what_is_appended_keeps_its_places_and_colours_and_wears_no_image() -> None:
    mesh = textured_box()
    both = append(mesh, red_triangle(mesh))
    np.testing.assert_array_equal(both.vertices[both.faces[12:]], [[[5, 0, 0], [6, 0, 0], [5, 1, 0]]])
    np.testing.assert_array_equal(both.corner_colours[12:], [[[1, 0, 0]] * 3])
    assert both.face_textures[12:].tolist() == [-1]


def test_a_mesh_is_the_sum_of_its_parts() -> None:
    vertices, faces, _ = box()
    first = coloured(vertices, faces, vertices)
    other_vertices, other_faces = icosahedron()
    second = painted(first, other_vertices + 3.0, other_faces, np.full((20, 3, 3), 0.5))
    both = append(first, second)
    again = [select_faces(both, part) for part in (np.arange(32) < 12, np.arange(32) >= 12)]
    for part, source in zip(again, (first, second), strict=True):
        np.testing.assert_array_equal(part.vertices[part.faces], source.vertices[source.faces])
        np.testing.assert_array_equal(part.corner_colours, source.corner_colours)
