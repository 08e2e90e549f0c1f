"""Small catalogues for the tests of `index`, made in code."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from sqlalchemy import Engine

from index.catalogue import Catalogue
from index.database import make_engine
from index.migrating import migrate
from index.pgvector.opening import views
from index.queue import Queue
from index.searcher import Searcher
from index.shapes import Shape, StoredFile
from index.vocabulary import Vocabulary
from tests.databases import DATABASES

FINGERPRINT = "0123456789abcdef"
HISTOGRAM = {"colour-histogram": np.array([0.5, 0.0, 0.5], dtype=np.float32)}
WORDS = {"hks-0": np.array([0.25, 0.75], dtype=np.float32)}

Numbers = Mapping[str, npt.NDArray[np.float32]]


@dataclass(frozen=True, kw_only=True)
class Opened:
    """A catalogue with its queue."""

    engine: Engine  # of its database
    catalogue: Catalogue  # with one active vocabulary
    queue: Queue  # its jobs
    vocabulary_id: str  # the active one


def make_vocabulary(number: int = 1, fingerprint: str = FINGERPRINT) -> Vocabulary:
    """Return a vocabulary without words; each number gives another."""
    return Vocabulary(
        fingerprint=fingerprint, words={}, grids={"diffusion-geometric": np.arange(number + 1.0)}
    )


def open_catalogue(folder: Path) -> Opened:
    """Open the catalogue of a folder, made where there is none."""
    engine = make_engine(DATABASES.url(folder))
    migrate(engine)
    catalogue = Catalogue(engine)
    active = catalogue.state().vocabulary_id
    if active is None:
        vocabulary = make_vocabulary()
        active = vocabulary.id
        catalogue.add_vocabulary(vocabulary)
        catalogue.activate(active)
    return Opened(engine=engine, catalogue=catalogue, queue=Queue(engine), vocabulary_id=active)


def make_searcher(opened: Opened, folder: Path) -> Searcher:
    """Return a searcher with its vectors where the tests of this module want them."""
    make = views(opened.catalogue, opened.engine) if DATABASES.index == "pgvector" else None
    return Searcher(opened.catalogue, folder, make)


def add_queued(opened: Opened, shape_id: str, **metadata: object) -> Shape:
    """Accept a shape whose content nobody else has."""
    file = StoredFile(name="a.ply", key=f"shapes/{shape_id}/files/0", size=3, sha256="ab")
    shape, _ = opened.catalogue.accept(
        id=shape_id, name=f"shape {shape_id}", metadata=metadata, sha256=f"sum of {shape_id}", files=[file]
    )
    return shape


def add_ready(opened: Opened, shape_id: str, blocks: Numbers = HISTOGRAM, words: Numbers = WORDS) -> Shape:
    """Accept a shape and describe it; nothing else may wait in the queue."""
    add_queued(opened, shape_id)
    job = opened.queue.claim("test", 60)
    if job is None or job.shape_id != shape_id:
        raise RuntimeError(f"expected the job of {shape_id}, got {job}")
    return opened.catalogue.record_ready(
        job,
        facts={"vertices": 3},
        fingerprint=FINGERPRINT,
        blocks=blocks,
        quantised=words,
        vocabulary_id=opened.vocabulary_id,
    )
