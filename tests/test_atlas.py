"""Patches of an atlas keep their shape and do not overlap."""

import numpy as np

from service.samples.atlas import unwrap
from service.samples.creatures import make_creature
from service.samples.palettes import COATS
from service.samples.texturing import bake, obj_files
from worker.pictures.rasterising import rasterise
from worker.reading.mesh import Colour
from worker.reading.upload import Upload, read_mesh

SHELL = make_creature("fish", COATS["reef"], n_vertices=2000)


def test_every_corner_lies_inside_the_picture() -> None:
    atlas = unwrap(SHELL, 256)
    assert atlas.texels.min() >= 0
    assert atlas.texels.max() <= 256
    assert atlas.faces.shape == SHELL.faces.shape


def test_patches_do_not_overlap() -> None:
    atlas = unwrap(SHELL, 256)
    a, b, c = (atlas.texels[column] for column in atlas.faces.T)
    (x, y), (u, v) = (b - a).T, (c - a).T
    areas = np.abs(x * v - y * u).sum() / 2
    seen = rasterise(atlas.texels, np.zeros(len(atlas.texels)), atlas.faces, atlas.side)
    assert len(seen.places) > 0.9 * areas


def test_the_baked_picture_holds_the_paint() -> None:
    atlas = unwrap(SHELL, 512)
    picture = bake(SHELL, atlas)
    assert picture.shape == (512, 512, 3)
    assert (picture.reshape(-1, 3).max(0) > 200).all()
    assert np.unique(picture.reshape(-1, 3), axis=0).shape[0] > 100


def test_the_files_read_back_as_a_textured_mesh() -> None:
    mesh = read_mesh(Upload(files=obj_files(SHELL, "fish")))
    assert mesh.colour == Colour.TEXTURE
    assert mesh.faces.shape == SHELL.faces.shape
    np.testing.assert_allclose(mesh.vertices[mesh.faces], SHELL.vertices[SHELL.faces], atol=1e-4)
