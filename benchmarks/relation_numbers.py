"""What relations are told by, computed for many meshes and kept, so that a stopped run goes on from there."""

import hashlib
from collections.abc import Iterable, Sequence
from concurrent.futures import Executor, as_completed
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path

import numpy as np

from benchmarks.relation_meshes import Read, Variant, coloured
from index.packing import rounded
from index.vocabulary import default_vocabulary
from service.quantisation import quantise
from service.relations.postures import posture_of
from service.relations.sides import CURVES, HISTOGRAM, NAMES, WORDS, Side
from worker.arrays import SingleArray
from worker.canonical import Surface, paint, stretch_canvas
from worker.describe import in_single_precision
from worker.descriptors.curves import colour_curves, whiten_curves
from worker.descriptors.histograms import join_bins, lab_histogram
from worker.geometry.repair import repair
from worker.geometry.resampling import face_areas
from worker.intrinsic import Intrinsic, describe_triangles
from worker.parameters import Parameters
from worker.pictures.preview import preview

AREA, PREVIEW = "area", "preview"  # of the file, in its own unit; the bytes of the preview
CHANGE = "change"  # mean distance in Lab to the model's own colours, at the same points


@dataclass(frozen=True, kw_only=True)
class Kept:
    """A folder with one file for each mesh."""

    path: Path

    def file(self, variant: Variant) -> Path:
        """Return where the numbers of a mesh are."""
        text = f"{Parameters().fingerprint()}/{variant.name}"
        return self.path / f"{hashlib.sha256(text.encode()).hexdigest()[:32]}.npz"

    def side(self, variant: Variant) -> Side:
        """Return a mesh as what is compared; its file is shared with nothing but itself."""
        with np.load(self.file(variant), allow_pickle=False) as arrays:
            blocks = {name: arrays[name] for name in NAMES}
            glb, area = arrays[PREVIEW].tobytes(), float(arrays[AREA])
        return Side(
            blocks=blocks,
            area=area,
            mesh_files=frozenset({variant.name}),
            preview=lambda: glb,
            posture=cache(partial(posture_of, glb)),
        )

    def change(self, variant: Variant) -> float:
        """Return by how much the colours differ from the model's own, Lab units."""
        with np.load(self.file(variant), allow_pickle=False) as arrays:
            return float(arrays[CHANGE])


def describe_all(pool: Executor, kept: Kept, surfaces: Iterable[tuple[Read, Sequence[Variant]]]) -> None:
    """Describe what is not kept yet."""
    kept.path.mkdir(parents=True, exist_ok=True)
    running = []
    for read, variants in surfaces:
        new = [variant for variant in variants if not kept.file(variant).exists()]
        if new:
            running.append(pool.submit(_describe_group, kept, read, new))
    for done in as_completed(running):
        done.result()


def _describe_group(kept: Kept, read: Read, variants: Sequence[Variant]) -> None:
    """Describe meshes that differ in colour alone."""
    parameters, mesh = Parameters(), read()
    repaired = repair(mesh)
    canvas = stretch_canvas(repaired, parameters)
    intrinsic = describe_triangles(canvas.vertices, canvas.faces, parameters)
    own = paint(mesh, canvas)
    area = np.array(face_areas(repaired.vertices, repaired.faces).sum())
    for variant in variants:
        surface = paint(coloured(mesh, variant), canvas)
        change = np.linalg.norm(surface.sample_lab - own.sample_lab, axis=1).mean()
        numbers = {**_blocks(surface, intrinsic, parameters), AREA: area, CHANGE: change}
        picture = preview(surface.vertices, surface.faces, surface.srgb)
        aside = kept.file(variant).with_suffix(".part")
        with aside.open("wb") as stream:
            np.savez(stream, allow_pickle=False, **numbers, **{PREVIEW: np.frombuffer(picture, np.uint8)})
        aside.replace(kept.file(variant))


def _blocks(surface: Surface, intrinsic: Intrinsic, parameters: Parameters) -> dict[str, SingleArray]:
    """Return the blocks of a side, as an index compares them."""
    histogram = join_bins(
        lab_histogram(surface.sample_lab, parameters.histogram_bins, parameters.histogram_smoothing),
        parameters.histogram_bins,
        parameters.histogram_lightness,
        parameters.histogram_chroma,
    )
    curves = colour_curves(intrinsic.orders, surface.lab, intrinsic.areas, parameters.curve_bins)
    blocks = in_single_precision({HISTOGRAM: histogram, CURVES: whiten_curves(curves)})
    vocabulary = default_vocabulary()
    words = replace(vocabulary, words={WORDS: vocabulary.words[WORDS]}, grids={})
    blocks |= quantise(in_single_precision(intrinsic.signatures), words)
    return {name: rounded(name, block) for name, block in blocks.items()}
