"""Describing the meshes of an evaluation: what shares triangles is resampled and solved once."""

from collections.abc import Iterable, Iterator
from concurrent.futures import Executor, as_completed
from dataclasses import dataclass
from pathlib import Path

from index.vocabulary import Vocabulary
from service.evaluation.cache import Cache, Described
from service.evaluation.making import coloured, damaged
from service.evaluation.protocol import Geometry, Recipe
from service.evaluation.sources import read_source
from service.quantisation import quantise
from service.refining import QUERY_LADDER
from worker.canonical import Surface, paint, stretch_canvas
from worker.describe import describe_surface, in_single_precision
from worker.errors import MeshError
from worker.geometry.repair import repair
from worker.intrinsic import Intrinsic, describe_triangles
from worker.parameters import Parameters

TOGETHER = 10  # meshes described by one process: few enough to share out evenly, enough to share triangles


@dataclass(frozen=True, kw_only=True, eq=False)
class Setting:
    """What every description of an evaluation has in common."""

    folder: Path
    cache: Path
    parameters: Parameters
    vocabulary: Vocabulary

    def open_cache(self) -> Cache:
        """Return the cache of these settings."""
        return Cache(self.cache, self.folder, (self.parameters.fingerprint(), self.vocabulary.id))


def missing(cache: Cache, recipes: Iterable[Recipe]) -> list[Recipe]:
    """Return those that are not described yet, each once."""
    return [recipe for recipe in dict.fromkeys(recipes) if recipe not in cache]


def describe_all(pool: Executor, setting: Setting, recipes: Iterable[Recipe]) -> Iterator[int]:
    """Describe meshes in the pool's processes, into the cache.

    Yields
    ------
    int
        How many more are done, as they are.
    """
    running = {pool.submit(describe_group, setting, *group): group[1] for group in groups_of(recipes)}
    for done in as_completed(running):
        try:
            done.result()
        except MeshError as error:  # over the limits of a job
            cache = setting.open_cache()
            _refuse(cache, missing(cache, running[done]), error)
        yield len(running[done])


def describe_group(setting: Setting, geometry: Geometry, recipes: tuple[Recipe, ...]) -> None:
    """Describe meshes that differ in colour alone; what is refused is stored with its reason."""
    cache = setting.open_cache()
    try:
        mesh = damaged(read_source(setting.folder, geometry.source), geometry)
        canvas = stretch_canvas(repair(mesh), setting.parameters)
        intrinsic = describe_triangles(canvas.vertices, canvas.faces, setting.parameters)
    except MeshError as error:
        _refuse(cache, recipes, error)
        return
    for recipe in recipes:
        try:
            surface = paint(coloured(mesh, recipe), canvas)
            cache.store(recipe, _describe(surface, intrinsic, setting))
        except MeshError as error:
            _refuse(cache, [recipe], error)


def _describe(surface: Surface, intrinsic: Intrinsic, setting: Setting) -> Described:
    blocks, signatures = describe_surface(surface, setting.parameters, intrinsic)
    single = in_single_precision(signatures)
    quantised = quantise(single, setting.vocabulary)
    return Described(blocks={**in_single_precision(blocks), **quantised, QUERY_LADDER: single[QUERY_LADDER]})


def _refuse(cache: Cache, recipes: Iterable[Recipe], error: MeshError) -> None:
    for recipe in recipes:
        cache.store(recipe, Described(blocks={}, refused=str(error)))


def groups_of(recipes: Iterable[Recipe]) -> Iterator[tuple[Geometry, tuple[Recipe, ...]]]:
    """Yield meshes that share triangles, at most TOGETHER at a time."""
    by_geometry: dict[Geometry, list[Recipe]] = {}
    for recipe in recipes:
        by_geometry.setdefault(recipe.geometry, []).append(recipe)
    for geometry, sharing in by_geometry.items():
        for start in range(0, len(sharing), TOGETHER):
            yield geometry, tuple(sharing[start : start + TOGETHER])
