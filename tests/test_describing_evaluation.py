"""Meshes that share triangles are described together, and each as it would be alone."""

from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from service.evaluation import describing
from service.evaluation.describing import TOGETHER, Setting, describe_all, describe_group, missing
from service.evaluation.folder import read_folder
from service.evaluation.making import coloured, damaged
from service.evaluation.protocol import BENT, PARTIAL, STRENGTHS, Geometry, Recipe
from service.evaluation.sources import read_source
from service.evaluation.suites import suites
from service.quantisation import quantise
from tests.evaluations import COARSE, InThisProcess, coarse_vocabulary, make_folder, setting_for
from tests.mesh_files import ply_ascii
from worker.arrays import SingleArray
from worker.canonical import canonical_surface
from worker.describe import describe_surface, in_single_precision
from worker.errors import Code, MeshError
from worker.geometry.repair import repair
from worker.reading.mesh import Mesh

REST = "posed/fish/pose_00.ply"
FLAT = ply_ascii(np.arange(9.0).reshape(3, 3), [[0, 1, 2]])  # three points on a line
POINTS = ply_ascii(np.eye(3), [])
WHOLE = Geometry(model="fish", source=REST)
RELIT = (
    Recipe(geometry=WHOLE),
    Recipe(geometry=WHOLE, changes=("hue",), strength=3, label="fish/hue"),
    Recipe(geometry=WHOLE, changes=("noise", "contrast+"), strength=2, label="fish/mixed"),
    Recipe(geometry=WHOLE, coat=1),
)


class OverTheLimits(InThisProcess):
    """Refuses every job, as a pool does where a job takes too long."""

    def submit(self, fn: Callable[..., Any], /, *_: Any, **__: Any) -> Future[Any]:
        """Return what failed already."""
        failed: Future[Any] = Future()
        failed.set_exception(MeshError(Code.TOO_COMPLEX, f"{fn.__name__} needs more than 300 s"))
        return failed


@pytest.fixture
def setting(tmp_path: Path) -> Setting:
    return setting_for(make_folder(tmp_path / "folder"), tmp_path / "cache")


def described_alone(setting: Setting, recipe: Recipe) -> dict[str, SingleArray]:
    """Describe one mesh by the chain that uploads go through."""
    mesh = coloured(damaged(read_source(setting.folder, REST), recipe.geometry), recipe)
    blocks, signatures = describe_surface(canonical_surface(mesh, repair(mesh), COARSE), COARSE)
    single = in_single_precision(signatures)
    ladder = {"landmark-ladder": single["landmark-ladder"]}
    return {**in_single_precision(blocks), **quantise(single, coarse_vocabulary()), **ladder}


@pytest.mark.parametrize(("damage", "strength"), [("whole", 0), (BENT, 3), (PARTIAL, 2), (PARTIAL, 3)])
def test_a_mesh_is_described_in_a_group_as_it_is_alone(setting: Setting, damage: str, strength: int) -> None:
    shared = replace(WHOLE, damage=damage, strength=strength)
    recipes = tuple(replace(recipe, geometry=shared) for recipe in RELIT)
    describe_group(setting, shared, recipes)
    for recipe in recipes[:: 1 if damage == "whole" else 2]:
        found = setting.open_cache().load(recipe).blocks
        expected = described_alone(setting, recipe)
        assert found.keys() == expected.keys()
        for name, block in expected.items():
            np.testing.assert_array_equal(found[name], block, strict=True)


@pytest.mark.parametrize("content", [b"", POINTS, FLAT])
@pytest.mark.parametrize(("damage", "strength"), [("whole", 0), (BENT, 1), (PARTIAL, 1), (PARTIAL, 2)])
def test_a_refused_mesh_is_stored_with_its_reason(
    setting: Setting, content: bytes, damage: str, strength: int
) -> None:
    (setting.folder / REST).write_bytes(content)
    shared = replace(WHOLE, damage=damage, strength=strength)
    recipes = tuple(replace(Recipe(geometry=shared), label=label) for label in "ab")
    describe_group(setting, shared, recipes)
    for recipe in recipes:
        found = setting.open_cache().load(recipe)
        assert found.blocks == {}
        assert found.refused is not None
        assert found.refused.split(":")[0] in {Code.EMPTY, Code.NO_FACES, Code.ZERO_AREA}


def test_a_refusal_does_not_take_others_of_its_group_along(
    setting: Setting, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refusing(mesh: Mesh, recipe: Recipe) -> Mesh:
        if recipe.label == "b":
            raise MeshError(Code.UNSOLVED, "a pair is missing")
        return coloured(mesh, recipe)

    monkeypatch.setattr(describing, "coloured", refusing)
    recipes = tuple(replace(Recipe(geometry=WHOLE), label=label) for label in "abc")
    describe_group(setting, WHOLE, recipes)
    found = [setting.open_cache().load(recipe).refused for recipe in recipes]
    assert found == [None, "unsolved: a pair is missing", None]


def test_what_is_over_the_limits_of_a_job_is_refused_too(setting: Setting) -> None:
    recipes = [Recipe(geometry=WHOLE), Recipe(geometry=WHOLE, coat=0)]
    describe_group(setting, WHOLE, tuple(recipes[:1]))
    assert sum(describe_all(OverTheLimits(), setting, recipes)) == 2
    found = [setting.open_cache().load(recipe).refused for recipe in recipes]
    assert found == [None, "too_complex: describe_group needs more than 300 s"]


def test_what_is_missing_is_named_once(setting: Setting) -> None:
    recipes = [Recipe(geometry=WHOLE, coat=coat) for coat in (0, 1, 0)]
    cache = setting.open_cache()
    assert missing(cache, recipes) == recipes[:2]
    describe_group(setting, WHOLE, (recipes[0],))
    assert missing(cache, recipes) == [recipes[1]]


def test_jobs_share_triangles_and_are_of_even_size(setting: Setting, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(describing, "describe_group", lambda *_: None)
    (suite,) = suites(read_folder(setting.folder), twins=False, hard=False)
    recipes = list(dict.fromkeys(suite.recipes()))
    pool = InThisProcess()
    assert sum(describe_all(pool, setting, recipes)) == len(recipes)
    jobs = [(found, group) for _, found, group in pool.submitted]
    assert sorted(map(repr, recipes)) == sorted(repr(recipe) for _, group in jobs for recipe in group)
    for found, group in jobs:
        assert {recipe.geometry for recipe in group} == {found}
        assert 0 < len(group) <= TOGETHER
    bent = [group for found, group in jobs if found.damage == BENT]
    assert len(bent) == 2 * len(STRENGTHS)
    assert all(len(group) == 2 for group in bent)  # isometry+topology, and mixed
