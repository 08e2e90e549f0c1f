"""Print how well each method finds a model's rest pose from its other poses, among all others.

The folder holds `posed/NAME/pose_XX.ply` (pose_00 is the rest pose) and `clutter/*.ply`. The queries are all
other poses; the gallery holds the rest poses and the clutter. Run by `make retrieval`.
"""

import argparse
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table
from threadpoolctl import threadpool_limits

from index.methods import METHODS, Method
from index.vocabulary import Vocabulary, default_vocabulary, learn_vocabulary
from service.quantisation import quantise
from worker.arrays import FloatArray, SingleArray
from worker.describe import Description, describe
from worker.reading.upload import Upload

REST = "pose_00"
Blocks = Mapping[str, SingleArray]


@dataclass(frozen=True, kw_only=True, eq=False)
class Described:
    """One mesh of the folder."""

    model: str  # poses of one model share it
    rest: bool  # belongs to the gallery
    blocks: Blocks  # that need no vocabulary
    signatures: Mapping[str, SingleArray]


def main() -> None:
    """Print mean reciprocal ranks with the shipped vocabulary and with one learnt from the folder."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("folder", type=Path)
    arguments.add_argument("--workers", type=int, default=2)
    options = arguments.parse_args()
    meshes = describe_folder(options.folder, options.workers)
    fingerprint = default_vocabulary().fingerprint
    own = learn_vocabulary((mesh.signatures for mesh in meshes), fingerprint)
    shipped_ranks = mean_reciprocal_ranks(meshes, default_vocabulary())
    own_ranks = mean_reciprocal_ranks(meshes, own)
    table = Table("method", "shipped vocabulary", "vocabulary of the folder", title="mean reciprocal rank")
    for name in shipped_ranks:
        table.add_row(name, f"{shipped_ranks[name]:.3f}", f"{own_ranks[name]:.3f}")
    Console().print(table)


def describe_folder(folder: Path, workers: int) -> list[Described]:
    """Describe every mesh of the folder, in processes."""
    paths = [*sorted(folder.glob("posed/*/*.ply")), *sorted(folder.glob("clutter/*.ply"))]
    with ProcessPoolExecutor(workers, mp_context=get_context("forkserver")) as pool:
        described = list(pool.map(describe_files, ({path.name: path.read_bytes()} for path in paths)))
    return [
        Described(
            model=str(path.parent if path.parent.parent.name == "posed" else path),
            rest=path.stem == REST or path.parent.parent.name != "posed",
            blocks=found.blocks,
            signatures=found.signatures,
        )
        for path, found in zip(paths, described, strict=True)
    ]


def describe_files(files: Mapping[str, bytes]) -> Description:
    """Describe one mesh on one thread."""
    with threadpool_limits(1):
        return describe(Upload(files=files))


def mean_reciprocal_ranks(meshes: Sequence[Described], vocabulary: Vocabulary) -> dict[str, float]:
    """Return for each method the mean over queries of one over the rank of the right model."""
    blocks = [{**mesh.blocks, **quantise(mesh.signatures, vocabulary)} for mesh in meshes]
    gallery = [k for k, mesh in enumerate(meshes) if mesh.rest]
    ranks: dict[str, list[float]] = {name: [] for name in METHODS}
    for query, mesh in enumerate(meshes):
        if mesh.rest:
            continue
        right = next(place for place, k in enumerate(gallery) if meshes[k].model == mesh.model)
        for name, reciprocals in ranks.items():
            found = distances(METHODS[name], blocks[query], [blocks[k] for k in gallery])
            reciprocals.append(1.0 / (1 + np.count_nonzero(np.delete(found, right) <= found[right])))
    return {name: float(np.mean(reciprocals)) for name, reciprocals in ranks.items()}


def distances(method: Method, query: Blocks, gallery: Sequence[Blocks]) -> FloatArray:
    """Return Σ_b w_b ‖x_b − y_b‖₁^p of a query to each of a gallery, by the formula."""
    total = np.zeros(len(gallery))
    for block in method.blocks:
        rows = np.stack([blocks[block.name] for blocks in gallery]).astype(np.float64)
        total += block.weight * np.abs(rows - query[block.name]).sum(axis=1) ** block.power
    return total


if __name__ == "__main__":
    main()
