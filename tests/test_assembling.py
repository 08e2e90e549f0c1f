"""Each triangle gets the richest colour that the files have for it."""

from dataclasses import replace

import numpy as np
import pytest

from tests.mesh_files import png
from worker.errors import Code, MeshError
from worker.reading.assembling import assemble, needed_maps
from worker.reading.contents import Material, Surface, TextureMap
from worker.reading.limits import Limits
from worker.reading.mesh import Colour, Mesh
from worker.reading.references import SentFiles

MAP = TextureMap(reference="t.png", named_by="m.mtl")
SURFACE = Surface(
    vertices=np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]),
    corners=np.array([0, 1, 2, 3, 0, 1, 2]),
    counts=np.array([4, 3]),
    corner_uvs=np.array([[0.0, 0], [1, 0], [1, 1], [0, 1], [0, 0], [1, 0], [1, 1]]),
    face_has_uvs=np.array([True, True]),
    face_materials=np.array([0, -1]),
    materials=(Material(name="a", colour=(1.0, 0.0, 0.0), texture=MAP),),
    vertex_colours=None,
    face_colours=None,
    warnings=("as read",),
)


def made(surface: Surface, *, allow_untextured: bool = False, files: dict[str, bytes] | None = None) -> Mesh:
    sent = SentFiles({"t.png": png()} if files is None else files)
    return assemble(surface, sent, allow_untextured=allow_untextured, limits=Limits())


def test_a_texture_comes_before_all_other_colours() -> None:
    mesh = made(replace(SURFACE, vertex_colours=np.ones((4, 3))))
    assert mesh.colour == Colour.TEXTURE
    assert mesh.face_textures.tolist() == [0, 0, -1]
    assert mesh.corner_uvs[0].tolist() == SURFACE.corner_uvs[[0, 1, 2]].tolist()
    assert mesh.warnings[0] == "as read"


def test_without_texture_vertex_colours_come_before_face_colours_before_materials() -> None:
    bare = replace(SURFACE, face_has_uvs=np.array([False, False]))
    assert made(bare).colour == Colour.MATERIAL
    assert made(bare).corner_colours[:, 0].tolist() == [[1, 0, 0], [1, 0, 0], [0.5, 0.5, 0.5]]
    faces = replace(bare, face_colours=np.array([[0.0, 1, 0], [0, 0, 1]]))
    assert made(faces).colour == Colour.FACE
    assert made(faces).corner_colours[:, 0].tolist() == [[0, 1, 0], [0, 1, 0], [0, 0, 1]]
    vertices = replace(faces, vertex_colours=np.eye(4)[:, :3])
    assert made(vertices).colour == Colour.VERTEX
    assert made(vertices).corner_colours[2].tolist() == np.eye(3).tolist()


def test_one_image_of_many_materials_is_decoded_once() -> None:
    materials = tuple(Material(name=str(number), texture=MAP) for number in range(2))
    mesh = made(replace(SURFACE, materials=materials, face_materials=np.array([0, 1])))
    assert len(mesh.textures) == 1
    assert mesh.face_textures.tolist() == [0, 0, 0]


def test_texture_coordinates_are_scaled_and_then_moved() -> None:
    material = Material(name="a", texture=replace(MAP, scale=(2.0, 3.0), offset=(0.5, 0.0)))
    mesh = made(replace(SURFACE, materials=(material,)))
    assert mesh.corner_uvs[0].tolist() == [[0.5, 0], [2.5, 0], [2.5, 3]]
    assert mesh.corner_uvs[2].tolist() == [[0, 0], [1, 0], [1, 1]]


def test_only_an_image_that_faces_show_is_missed() -> None:
    with pytest.raises(MeshError) as caught:
        made(SURFACE, files={})
    assert caught.value.code == Code.MISSING_TEXTURE
    assert "t.png" in caught.value.detail
    unused = replace(SURFACE, face_materials=np.array([-1, -1]))
    assert needed_maps(unused) == {}
    assert made(unused, files={}).colour == Colour.NONE


def test_a_missing_image_leaves_the_colour_of_its_material_on_request() -> None:
    mesh = made(SURFACE, files={}, allow_untextured=True)
    assert mesh.colour == Colour.MATERIAL
    assert "“t.png”" in mesh.warnings[1]


def test_more_triangles_than_the_limit_are_refused_before_they_are_made() -> None:
    with pytest.raises(MeshError, match="3 triangles; at most 2") as caught:
        assemble(SURFACE, SentFiles({}), allow_untextured=False, limits=Limits(faces=2))
    assert caught.value.code == Code.TOO_COMPLEX
