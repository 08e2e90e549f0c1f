import numpy as np

from tests.photograph import photograph
from tests.shapes import box, coloured, sphere
from worker.canonical import canonical_surface
from worker.descriptors.histograms import lab_histogram
from worker.geometry.areas import edge_lengths, triangle_areas
from worker.geometry.colour import srgb_to_lab
from worker.geometry.refinement import split_long_edges
from worker.geometry.repair import repair
from worker.parameters import Parameters
from worker.reading.mesh import Colour, Mesh

PARAMETERS = Parameters()


def box_with_photograph() -> Mesh:
    vertices, faces, uvs = box()
    return Mesh(
        vertices=vertices,
        faces=faces,
        corner_colours=np.ones((12, 3, 3)),
        corner_uvs=uvs,
        face_textures=np.zeros(12, dtype=np.int64),
        textures=(photograph(),),
        colour=Colour.TEXTURE,
        warnings=(),
    )


def test_a_box_of_12_triangles_shows_the_histogram_of_its_photograph() -> None:
    mesh = box_with_photograph()
    surface = canonical_surface(mesh, repair(mesh), PARAMETERS)
    image = srgb_to_lab(mesh.textures[0].reshape(-1, 3) / 255)
    own = lab_histogram(image, PARAMETERS.histogram_bins, PARAMETERS.histogram_smoothing)
    found = lab_histogram(surface.sample_lab, PARAMETERS.histogram_bins, PARAMETERS.histogram_smoothing)
    assert np.abs(found - own).sum() < 0.05


def test_the_photograph_is_seen_in_the_vertices_too() -> None:
    mesh = box_with_photograph()
    surface = canonical_surface(mesh, repair(mesh), PARAMETERS)
    image = srgb_to_lab(mesh.textures[0].reshape(-1, 3) / 255)
    np.testing.assert_allclose(surface.lab.mean(axis=0), image.mean(axis=0), atol=1.0)
    assert surface.lab[:, 0].std() > 0.6 * image[:, 0].std()


def test_every_surface_has_the_canonical_area_and_resolution() -> None:
    vertices, faces = sphere(3)
    mesh = coloured(1e-3 * vertices, faces, np.abs(vertices))
    surface = canonical_surface(mesh, repair(mesh), PARAMETERS)
    areas = triangle_areas(edge_lengths(surface.vertices, surface.faces))
    np.testing.assert_allclose(areas.sum(), PARAMETERS.surface_area)
    assert len(surface.vertices) == PARAMETERS.vertices


def test_colours_stay_where_they_were() -> None:
    vertices, faces = sphere(4)
    mesh = coloured(vertices, faces, 0.5 + vertices / 2)
    surface = canonical_surface(mesh, repair(mesh), PARAMETERS)
    places = surface.vertices / np.linalg.norm(surface.vertices, axis=1, keepdims=True)
    np.testing.assert_allclose(surface.srgb, 0.5 + places / 2, atol=0.02)


def test_colours_stay_where_they_were_on_a_mesh_that_is_denser_on_one_side() -> None:
    vertices, faces = sphere(4)
    above = (vertices[faces][:, :, 2] > 0.2).all(axis=1)
    fine, fine_faces = split_long_edges(vertices, faces[above], 0.02)
    whole = np.vstack([faces[~above], fine_faces])
    mesh = coloured(fine, whole, 0.5 + fine / 2)
    surface = canonical_surface(mesh, repair(mesh), PARAMETERS)
    places = surface.vertices / np.linalg.norm(surface.vertices, axis=1, keepdims=True)
    np.testing.assert_allclose(surface.srgb, 0.5 + places / 2, atol=0.03)


def test_corners_of_turned_faces_keep_their_colours() -> None:
    vertices, faces = sphere(3)
    mixed = faces.copy()
    mixed[::3] = mixed[::3, ::-1]  # every third face the other way round
    mesh = coloured(vertices, mixed, 0.5 + vertices / 2)
    surface = canonical_surface(mesh, repair(mesh), PARAMETERS)
    places = surface.vertices / np.linalg.norm(surface.vertices, axis=1, keepdims=True)
    np.testing.assert_allclose(surface.srgb, 0.5 + places / 2, atol=0.03)
