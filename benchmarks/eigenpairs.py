"""What eigenpairs, bags and distance distributions cost and lose, against the naive way in the same run.

Run by `make bench`, or alone: python -m benchmarks.eigenpairs [mesh or folder of meshes …].
"""

import argparse
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from benchmarks.naive import (
    Pairs,
    describe_naively,
    distribution_of,
    exact_pairs,
    signatures_of,
)
from index.vocabulary import default_vocabulary
from service.quantisation import quantise
from service.samples import random_creatures
from worker.arrays import SingleArray
from worker.canonical import Surface, canonical_surface
from worker.describe import in_single_precision
from worker.errors import MeshError
from worker.geometry.repair import repair
from worker.geometry.spectrum import count_below, pieces_of, system_of
from worker.intrinsic import describe_triangles, distribution, signatures_at
from worker.parameters import Operator, Parameters
from worker.reading.upload import Upload, read_mesh
from worker.solving import operator_of, solve_joint

SIZE = 10_000  # vertices at which ours and the naive way are compared
SIZES = (2_000, 5_000, 10_000, 20_000, 50_000, 200_000)
REPEATS = 3
SEED = 2011
ROUNDING = 1e-6  # of a distance: what single numbers leave
MADE = 200  # shapes on which pairs are counted

Row = Mapping[str, str]  # column → cell


@dataclass(frozen=True, kw_only=True)
class Count:
    """Pairs found below the cutoffs, against how many the inertia says that there are."""

    meshes: int
    spectra: int
    pairs: int
    differing: int  # spectra with more or fewer


def main() -> None:
    """Print all tables."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("paths", nargs="*", type=Path)
    paths = arguments.parse_args().paths
    with threadpool_limits(1):
        for row in (*comparison_rows(sample_surface(SIZE)), *size_rows()):
            print(row)
        for name, uploads in (("made", made_uploads(MADE)), ("given", file_uploads(paths))):
            print(name, count_pairs(uploads, Parameters()))


def comparison_rows(surface: Surface, repeats: int = REPEATS) -> Iterator[Row]:
    """Yield one row for each operator: CPU-seconds of both ways, medians, and what ours loses."""
    for operator, n_naive in ((Operator.COTANGENT, repeats), (Operator.MESH_LAPLACE, 1)):
        parameters = Parameters(vertices=len(surface.vertices), operator=operator)
        ours = seconds_of(partial(describe_eigen_part, surface, parameters), repeats)
        arrays = surface.vertices, surface.faces, surface.lab
        words = default_vocabulary().words
        naive = seconds_of(partial(describe_naively, *arrays, parameters, words), n_naive, warm=False)
        signatures, distributions = losses(surface, parameters)
        yield {
            "what": f"four η, {operator}, {len(surface.vertices):,} vertices",
            "naive, s": f"{naive:.2f}",
            "ours, s": f"{ours:.3f}",
            "ratio": f"{naive / ours:.1f}",
            "HKS, largest relative error": f"{signatures:.1e}",
            "distributions, largest difference": f"{distributions:.1e}",
        }


def size_rows(sizes: Sequence[int] = SIZES) -> Iterator[Row]:
    """Yield what ours costs at canonical resolutions of the same shape."""
    for size in sizes:
        surface = sample_surface(size)
        seconds = seconds_of(partial(describe_eigen_part, surface, Parameters(vertices=size)), REPEATS)
        yield {
            "what": "four η, cotangent",
            "vertices": f"{len(surface.vertices):,}",
            "ours, s": f"{seconds:.3f}",
            "µs a vertex": f"{1e6 * seconds / len(surface.vertices):.1f}",
        }


def describe_eigen_part(surface: Surface, parameters: Parameters) -> dict[str, SingleArray]:
    """Compute what a description takes from eigenpairs, as `worker.describe` does, and its bags."""
    shared = describe_triangles(surface.vertices, surface.faces, parameters)
    spectra = {0.0: shared.spectrum}
    for weight in {*parameters.colour_weights, *parameters.distance_weights} - {0.0}:
        spectra[weight] = solve_joint(surface.vertices, surface.faces, surface.lab, weight, parameters)
    signatures = dict(shared.signatures)
    for weight in parameters.colour_weights:
        signatures[f"hks-{weight:g}"] = signatures_at(spectra[weight], parameters.times)
    joint = [spectra[weight] for weight in parameters.distance_weights]
    signatures["diffusion-joint"] = distribution(joint, shared.samples, shared.shares, parameters)
    vocabulary = default_vocabulary()
    words = {name: words for name, words in vocabulary.words.items() if name in signatures}
    return quantise(in_single_precision(signatures), replace(vocabulary, words=words))


def losses(surface: Surface, parameters: Parameters) -> tuple[float, float]:
    """Compare with 200 exact pairs of the same operators.

    Returns
    -------
    signatures : float
        Largest relative error of a heat kernel signature.
    distributions : float
        Largest difference of a distribution of distances, F at the quantiles found from their levels.
    """
    shared = describe_triangles(surface.vertices, surface.faces, parameters)
    exact, found, worst = {}, {}, 0.0
    for weight in sorted({*parameters.colour_weights, *parameters.distance_weights}):
        exact[weight] = exact_pairs(
            *operator_of(surface.vertices, surface.faces, surface.lab, weight, parameters)
        )
        found[weight] = solve_joint(surface.vertices, surface.faces, surface.lab, weight, parameters)
        expected = signatures_of(exact[weight], parameters.times)
        errors = np.abs(signatures_at(found[weight], parameters.times) / expected - 1.0)
        worst = max(worst, float(errors.max()))
    differences = []
    for weights in ((0.0,), parameters.distance_weights):
        sampled = [
            Pairs(values=exact[weight].values, functions=exact[weight].functions[shared.samples])
            for weight in weights
        ]
        distances, cumulative = distribution_of(sampled, parameters.distance_times, shared.shares)
        quantiles = distribution(
            [found[weight] for weight in weights], shared.samples, shared.shares, parameters
        )
        levels = (np.arange(len(quantiles)) + 0.5) / len(quantiles)
        # Points of small pieces are equally far from all others: F may jump at a distance.
        below, above = (
            cumulative[np.maximum(np.searchsorted(distances, quantiles * factor, side="right") - 1, 0)]
            for factor in (1.0 - ROUNDING, 1.0 + ROUNDING)
        )
        paired = levels > cumulative[0]  # below are points paired with themselves
        differences.append(np.maximum(below - levels, levels - above)[paired].max())
    return worst, float(max(differences))


def count_pairs(uploads: Iterator[Mapping[str, bytes]], parameters: Parameters) -> Count:
    """Compare the pairs found with the inertia at the cutoff, piece by piece, at η = 0 and the largest η."""
    meshes = spectra = pairs = differing = 0
    for files in uploads:
        try:
            surface = surface_of(files, parameters)
        except MeshError:
            continue
        meshes += 1
        for weight in (0.0, max(parameters.distance_weights)):
            arrays = surface.vertices, surface.faces, surface.lab
            try:
                found = len(solve_joint(*arrays, weight, parameters).eigenvalues)
                expected = inertia_of(surface, weight, parameters)
            except MeshError:  # the solver says that pairs are missing
                found, expected = 0, 1
            spectra, pairs, differing = spectra + 1, pairs + found, differing + (found != expected)
    return Count(meshes=meshes, spectra=spectra, pairs=pairs, differing=differing)


def inertia_of(surface: Surface, weight: float, parameters: Parameters) -> int:
    """Count the eigenvalues below the cutoff, of each connected piece at most the cap."""
    stiffness, mass = operator_of(surface.vertices, surface.faces, surface.lab, weight, parameters)
    cutoff = parameters.cutoff if weight else parameters.fine_cutoff
    return sum(
        min(count_below(system_of(surface.vertices[rows], piece, mass[rows]), cutoff), parameters.eigenpairs)
        for rows, piece in pieces_of(stiffness, mass)
    )


def sample_surface(n_vertices: int) -> Surface:
    """Return the canonical surface of one made creature."""
    return surface_of(next(random_creatures(1, SEED)).files, Parameters(vertices=n_vertices))


def surface_of(files: Mapping[str, bytes], parameters: Parameters) -> Surface:
    """Read and resample a mesh."""
    mesh = read_mesh(Upload(files=files))
    return canonical_surface(mesh, repair(mesh), parameters)


def made_uploads(count: int) -> Iterator[Mapping[str, bytes]]:
    """Yield the files of made shapes."""
    return (sample.files for sample in random_creatures(count, SEED))


def file_uploads(paths: Sequence[Path]) -> Iterator[Mapping[str, bytes]]:
    """Yield the files of each mesh: PLY alone, OBJ and GLTF with all that is beside them."""
    for path in paths:
        for mesh in sorted(path.rglob("*")) if path.is_dir() else [path]:
            if mesh.suffix in (".ply", ".glb", ".stl", ".off"):
                yield {mesh.name: mesh.read_bytes()}
            elif mesh.suffix in (".obj", ".gltf"):
                yield {
                    near.name: near.read_bytes() for near in sorted(mesh.parent.iterdir()) if near.is_file()
                }


def seconds_of(function: Callable[[], object], repeats: int, warm: bool = True) -> float:
    """Return the median processor time of a function; a warm one has run before, and is compiled."""
    times = []
    for _ in range(repeats + warm):
        start = time.process_time()
        function()
        times.append(time.process_time() - start)
    return float(np.median(times[warm:]))


if __name__ == "__main__":
    main()
