"""A twin has the triangles of its model and other colours, which follow from names and places alone."""

from itertools import combinations

import numpy as np

from service.evaluation.twins import make_twin
from tests.evaluations import textured_box
from tests.shapes import coloured, sheet, sphere
from tests.test_contacts import seamed
from worker.geometry.colour import srgb_to_lab
from worker.reading.mesh import Colour, Mesh


def ball() -> Mesh:
    vertices, faces = sphere(3)
    return coloured(vertices * [1.0, 2.0, 1.5], faces, (vertices + 1) / 2)


def distance(first: Mesh, second: Mesh) -> float:
    """Return the mean difference of colours at the same corners, in Lab."""
    labs = [srgb_to_lab(mesh.corner_colours.reshape(-1, 3)) for mesh in (first, second)]
    return float(np.linalg.norm(labs[0] - labs[1], axis=1).mean())


def test_a_twin_has_the_same_triangles() -> None:
    mesh = textured_box()
    twin = make_twin(mesh, "m", 0)
    assert twin.vertices is mesh.vertices
    assert twin.faces is mesh.faces


def test_a_twin_wears_colours_at_its_corners_and_no_image() -> None:
    twin = make_twin(textured_box(), "m", 0)
    assert twin.textures == ()
    assert (twin.face_textures == -1).all()
    assert twin.colour is Colour.VERTEX
    np.testing.assert_allclose(255 * twin.corner_colours, np.rint(255 * twin.corner_colours), atol=1e-9)
    assert 0 <= twin.corner_colours.min() <= twin.corner_colours.max() <= 1


def test_twins_differ_from_their_model_and_from_each_other() -> None:
    mesh = ball()
    twins = [make_twin(mesh, model, number) for model in ("m", "n") for number in range(3)]
    for first, second in combinations([mesh, *twins], 2):
        assert distance(first, second) > 10.0


def test_the_same_names_give_the_same_twin() -> None:
    first, again = (make_twin(ball(), "m", 7) for _ in range(2))
    np.testing.assert_array_equal(first.corner_colours, again.corner_colours)


def test_colours_follow_from_places_alone() -> None:
    vertices, faces = sheet(20)
    rows = coloured(vertices, faces, np.zeros_like(vertices))  # of equal height
    for mesh in map(seamed, (ball(), rows)):
        colours = make_twin(mesh, "m", 0).corner_colours.reshape(-1, 3)
        places, same = np.unique(mesh.vertices[mesh.faces].reshape(-1, 3), axis=0, return_inverse=True)
        assert len(places) < len(mesh.vertices)
        at_places = np.empty_like(places)
        at_places[same.ravel()] = colours
        np.testing.assert_array_equal(colours, at_places[same.ravel()])


def test_size_and_place_of_a_mesh_do_not_change_its_coat() -> None:
    mesh = ball()
    moved = coloured(1e3 * mesh.vertices + [4.0, -5.0, 6.0], mesh.faces, np.zeros_like(mesh.vertices))
    assert distance(make_twin(mesh, "m", 0), make_twin(moved, "m", 0)) < 0.1
