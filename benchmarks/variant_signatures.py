"""Every mesh of an evaluation in all variants of its descriptors but the bags; what they are made of is kept.

Two folders of a cache: what triangles decide, and what colours add.
"""

import time
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Executor, as_completed
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.variants import CURVE_BLOCKS, HISTOGRAMS, SHIPPED, Curves, Histogram
from service.commands.progress import progress_bar
from service.evaluation.cache import Cache, Described
from service.evaluation.describing import groups_of
from service.evaluation.making import coloured, damaged
from service.evaluation.protocol import Geometry, Recipe
from service.evaluation.sources import read_source
from service.refining import LANDMARKS, QUERY_LADDER
from worker.arrays import FloatArray, SingleArray
from worker.canonical import Surface, paint, stretch_canvas
from worker.describe import in_single_precision
from worker.descriptors.curves import colour_curves, whiten_curves
from worker.descriptors.histograms import join_bins, lab_histogram
from worker.descriptors.landmarks import pack, place_landmarks
from worker.errors import MeshError
from worker.geometry.repair import repair
from worker.intrinsic import Intrinsic, describe_triangles, signatures_at
from worker.parameters import Parameters
from worker.solving import solve_joint

VERSION = "1"  # raised when other numbers get the same name
SECONDS = "seconds"  # of processor time for the spectra at η > 0, kept beside what it gives


@dataclass(frozen=True, kw_only=True, eq=False)
class Bench:
    """Where meshes come from, by which numbers they are described, and where that is kept."""

    folder: Path
    cache: Path
    parameters: Parameters

    def colours(self) -> Cache:
        """Return what colours add: signatures at η > 0, histograms, curves, landmarks."""
        return self.open("colours")

    def triangles(self, geometry: Geometry) -> dict[str, SingleArray]:
        """Read what a geometry decides: areas, signatures at η = 0, heat at the landmarks."""
        return self.open("triangles").load(Recipe(geometry=geometry)).blocks

    def open(self, name: str, *versions: str) -> Cache:
        """Return a cache of these numbers."""
        histograms = (variant.name for variant in HISTOGRAMS)
        curves = (variant.name for variant in CURVE_BLOCKS)
        known = (VERSION, self.parameters.fingerprint(), *histograms, *curves, *versions)
        return Cache(self.cache / name, self.folder, known)


def describe(pool: Executor, bench: Bench, recipes: Iterable[Recipe]) -> None:
    """Describe all meshes that are not described yet."""
    colours = bench.colours()
    share_out(pool, "Describing", [r for r in recipes if r not in colours], describe_group, bench)


def share_out(
    pool: Executor, title: str, recipes: Iterable[Recipe], work: Callable[..., None], *context: Any
) -> None:
    """Do ``work(*context, geometry, recipes)`` on groups of meshes that share triangles, in processes."""
    running = {
        pool.submit(work, *context, geometry, group): len(group) for geometry, group in groups_of(recipes)
    }
    completed, total = 0, sum(running.values())
    with progress_bar(title, total) as advance:
        for done in as_completed(running):
            done.result()
            completed += running[done]
            advance(completed=completed, total=total)


def describe_group(bench: Bench, geometry: Geometry, recipes: tuple[Recipe, ...]) -> None:
    """Describe meshes that differ in colour alone, into the caches of triangles and colours."""
    colours = bench.colours()
    # distances are not compared here, and landmarks are the first of the points that those are taken between
    lean = replace(bench.parameters, distance_samples=bench.parameters.landmarks)
    try:
        mesh = damaged(read_source(bench.folder, geometry.source), geometry)
        canvas = stretch_canvas(repair(mesh), lean)
        intrinsic = describe_triangles(canvas.vertices, canvas.faces, lean)
        bench.open("triangles").store(Recipe(geometry=geometry), _described(_of_triangles(intrinsic, lean)))
        for recipe in recipes:
            surface = paint(coloured(mesh, recipe), canvas)
            colours.store(recipe, _described(_of_colours(surface, intrinsic, lean)))
    except MeshError as error:
        for recipe in recipes:
            colours.store(recipe, Described(blocks={}, refused=str(error)))


def histogram_of(variant: Histogram, surface: Surface, areas: FloatArray) -> FloatArray:
    """Return a Lab histogram of the surface's own colours, or of its vertices' means by their areas (n,)."""
    lab = surface.sample_lab
    if variant.cells:
        places = (np.arange(len(lab)) + 0.5) / len(lab) * areas.sum()
        lab = surface.lab[np.searchsorted(np.cumsum(areas), places)]
    histogram = lab_histogram(lab, variant.n_bins, variant.smoothing)
    if variant.chroma:
        return join_bins(histogram, variant.n_bins, SHIPPED.histogram_lightness, variant.chroma)
    return histogram


def curves_of(variant: Curves, surface: Surface, intrinsic: Intrinsic) -> FloatArray:
    """Return colour curves, whitened or as they are."""
    curves = colour_curves(intrinsic.orders, surface.lab, intrinsic.areas, variant.n_bins)
    return whiten_curves(curves) if variant.whitened else curves.ravel()


def _described(arrays: Mapping[str, FloatArray]) -> Described:
    return Described(blocks=in_single_precision(arrays))


def _of_triangles(intrinsic: Intrinsic, parameters: Parameters) -> dict[str, FloatArray]:
    signatures = intrinsic.signatures
    return {
        "areas": intrinsic.areas,
        "hks-0": signatures_at(intrinsic.spectrum, parameters.times),
        "log-hks": signatures["log-hks"],
        QUERY_LADDER: signatures[QUERY_LADDER],
    }


def _of_colours(surface: Surface, intrinsic: Intrinsic, parameters: Parameters) -> dict[str, FloatArray]:
    vertices, areas = surface.vertices, intrinsic.areas
    start = time.process_time()
    spectra = {
        f"hks-{eta:g}": solve_joint(vertices, surface.faces, surface.lab, eta, parameters)
        for eta in parameters.colour_weights
        if eta
    }
    seconds = time.process_time() - start
    placed = place_landmarks(vertices, intrinsic.landmarks, areas, surface.lab, parameters.landmarks)
    return {
        SECONDS: np.array([seconds]),
        LANDMARKS: pack(intrinsic.signatures[QUERY_LADDER], placed).ravel(),
        **{name: signatures_at(spectrum, parameters.times) for name, spectrum in spectra.items()},
        **{variant.name: histogram_of(variant, surface, areas) for variant in HISTOGRAMS},
        **{variant.name: curves_of(variant, surface, intrinsic) for variant in CURVE_BLOCKS},
    }
