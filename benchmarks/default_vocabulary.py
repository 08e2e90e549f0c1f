"""Learn the vocabulary that ships with the project, from shapes made by its own code.

Run by `make vocabulary`. Prints how many shapes were learnt from, and writes index/default-vocabulary.npz.
"""

import argparse
from collections.abc import Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

from benchmarks.describing import describe_files
from index.vocabulary import Vocabulary, learn_vocabulary
from service.samples import random_creatures
from worker.arrays import SingleArray
from worker.parameters import Parameters

TARGET = Path(__file__).parents[1] / "index" / "default-vocabulary.npz"
SEED = 2011


def main() -> None:
    """Learn and write."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--shapes", type=int, default=160)
    arguments.add_argument("--workers", type=int, default=2)
    options = arguments.parse_args()
    vocabulary = learn(options.shapes, options.workers)
    TARGET.write_bytes(vocabulary.to_bytes())
    print(f"{vocabulary.id}: learnt from {options.shapes} made shapes, {TARGET.stat().st_size:,} bytes")


def learn(n_shapes: int, workers: int) -> Vocabulary:
    """Learn a vocabulary from made creatures and things."""
    uploads = (sample.files for sample in random_creatures(n_shapes, SEED))
    with ProcessPoolExecutor(workers, mp_context=get_context("forkserver")) as pool:
        return learn_vocabulary(
            _counted(pool.map(_signatures, uploads), n_shapes), Parameters().fingerprint()
        )


def _counted(
    shapes: Iterator[Mapping[str, SingleArray]], n_shapes: int
) -> Iterator[Mapping[str, SingleArray]]:
    for count, signatures in enumerate(shapes, 1):
        if count % 20 == 0:
            print(f"{count} of {n_shapes} described", flush=True)
        yield signatures


def _signatures(files: Mapping[str, bytes]) -> Mapping[str, SingleArray]:
    return describe_files(files).signatures


if __name__ == "__main__":
    main()
