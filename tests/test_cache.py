"""What is described is kept whole, under what it follows from."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from service.evaluation.cache import Cache, Described
from service.evaluation.protocol import Geometry, Recipe
from service.evaluation.sources import MADE

SOURCE = "posed/a/pose_00.ply"
RECIPE = Recipe(geometry=Geometry(model="a", source=SOURCE))
BLOCKS = {
    "hks-0": np.linspace(0, 1, 48, dtype=np.float32),
    "landmark-ladder": np.arange(6, dtype=np.float32).reshape(2, 3),
}
OTHERS = [
    replace(RECIPE, coat=0),
    replace(RECIPE, coat=1),
    replace(RECIPE, changes=("hue",)),
    replace(RECIPE, changes=("hue", "noise")),
    replace(RECIPE, strength=1),
    replace(RECIPE, label="a/hue"),
    replace(RECIPE, geometry=replace(RECIPE.geometry, damage="bent")),
    replace(RECIPE, geometry=replace(RECIPE.geometry, strength=1)),
    replace(RECIPE, geometry=replace(RECIPE.geometry, model="b")),
]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    file = tmp_path / "folder" / SOURCE
    file.parent.mkdir(parents=True)
    file.write_bytes(b"a mesh")
    return tmp_path / "folder"


def opened(folder: Path, *versions: str) -> Cache:
    return Cache(folder.parent / "cache", folder, versions or ("parameters", "vocabulary"))


def test_what_was_stored_comes_back(folder: Path) -> None:
    assert RECIPE not in opened(folder)
    opened(folder).store(RECIPE, Described(blocks=BLOCKS))
    cache = opened(folder)
    assert RECIPE in cache
    found = cache.load(RECIPE)
    assert found.refused is None
    assert found.blocks.keys() == BLOCKS.keys()
    for name, block in BLOCKS.items():
        np.testing.assert_array_equal(found.blocks[name], block, strict=True)


def test_a_refusal_comes_back_with_its_reason(folder: Path) -> None:
    opened(folder).store(RECIPE, Described(blocks={}, refused="a mesh of Zoë has no faces"))
    found = opened(folder).load(RECIPE)
    assert (found.blocks, found.refused) == ({}, "a mesh of Zoë has no faces")


@pytest.mark.parametrize("other", OTHERS)
def test_each_recipe_has_an_entry_of_its_own(folder: Path, other: Recipe) -> None:
    cache = opened(folder)
    cache.store(RECIPE, Described(blocks=BLOCKS))
    assert other not in cache
    assert RECIPE in cache


def test_what_the_numbers_follow_from_is_part_of_an_entry(folder: Path) -> None:
    opened(folder, "parameters", "vocabulary").store(RECIPE, Described(blocks=BLOCKS))
    for versions in (("others", "vocabulary"), ("parameters", "another"), ("parametersvocabulary",)):
        assert RECIPE not in opened(folder, *versions)


def test_another_version_of_the_protocol_is_another_entry(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened(folder).store(RECIPE, Described(blocks=BLOCKS))
    monkeypatch.setattr("service.evaluation.cache.VERSION", -1)
    assert RECIPE not in opened(folder)


def test_a_mesh_that_changes_is_another_entry(folder: Path) -> None:
    opened(folder).store(RECIPE, Described(blocks=BLOCKS))
    (folder / SOURCE).write_bytes(b"another mesh")
    assert RECIPE not in opened(folder)
    (folder / SOURCE).write_bytes(b"a mesh")
    assert RECIPE in opened(folder)


def test_an_image_that_changes_makes_another_entry_of_its_obj(folder: Path) -> None:
    (folder / "posed/a/pose_00.obj").write_bytes(b"an obj")
    (folder / "posed/a/skin.png").write_bytes(b"red")
    recipe = replace(RECIPE, geometry=replace(RECIPE.geometry, source="posed/a/pose_00.obj"))
    for one in (recipe, RECIPE):
        opened(folder).store(one, Described(blocks=BLOCKS))
    (folder / "posed/a/skin.png").write_bytes(b"blue")
    assert recipe not in opened(folder)
    assert RECIPE in opened(folder)  # a PLY has no images


def test_shapes_made_by_code_have_no_file(folder: Path) -> None:
    made = [Recipe(geometry=Geometry(model=f"{MADE}{k}", source=f"{MADE}{k}")) for k in range(2)]
    cache = opened(folder)
    cache.store(made[0], Described(blocks=BLOCKS))
    assert made[0] in cache
    assert made[1] not in cache


def test_a_half_written_file_is_never_read(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def cut_off(stream: Any, **_: object) -> None:
        stream.write(b"PK\x03\x04 the first half")
        raise KeyboardInterrupt

    cache = opened(folder)
    with monkeypatch.context() as broken:
        broken.setattr(np, "savez", cut_off)
        with pytest.raises(KeyboardInterrupt):
            cache.store(RECIPE, Described(blocks=BLOCKS))
    assert RECIPE not in cache
    cache.store(RECIPE, Described(blocks=BLOCKS))
    np.testing.assert_array_equal(cache.load(RECIPE).blocks["hks-0"], BLOCKS["hks-0"])


def test_an_entry_is_replaced_whole(folder: Path) -> None:
    cache = opened(folder)
    cache.store(RECIPE, Described(blocks={}, refused="a reason"))
    cache.store(RECIPE, Described(blocks=BLOCKS))
    assert cache.load(RECIPE).refused is None
    assert len(list((folder.parent / "cache").iterdir())) == 1
