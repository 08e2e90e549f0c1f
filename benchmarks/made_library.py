"""A library of made shapes: mixtures of a few described creatures, put into the catalogue directly."""

import hashlib
from collections.abc import Mapping
from dataclasses import asdict
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from sqlalchemy import insert
from sqlalchemy.orm import Session

from index.blocks import encode_block
from index.database import writing
from index.revisions import lock_state, now
from index.shapes import Status
from index.tables import FileRow, PlainBlockRow, QuantisedBlockRow, ShapeRow
from service.library import Library
from service.quantisation import quantise
from service.samples import make_samples
from service.settings import Settings
from service.storage import THUMBNAIL, derived_key, save_signatures
from service.vocabularies import active_vocabulary
from worker.arrays import SingleArray
from worker.describe import Description, describe
from worker.reading.upload import Upload

DESCRIBED = 4  # creatures
APART = 4  # poses of a creature: every fourth sample is another one
WITH_FILES = 100  # shapes that have their signatures, and may be queries; as many have their pictures
NOISE = 0.02  # relative, of each number

Blocks = Mapping[str, SingleArray]


def make_library(folder: Path, n_shapes: int) -> list[str]:
    """Fill a new library; return the ids of its shapes."""
    described = [
        describe(Upload(files=sample.files)) for sample in islice(make_samples(), 0, DESCRIBED * APART, APART)
    ]
    library = Library.open(Settings(data_dir=folder))
    vocabulary = active_vocabulary(library)
    words = [quantise(description.signatures, vocabulary) for description in described]
    random = np.random.default_rng(0)
    ids = [hashlib.md5(str(number).encode(), usedforsecurity=False).hexdigest() for number in range(n_shapes)]
    with writing(library.engine) as session:
        for number, shape_id in enumerate(ids):
            one, other = random.integers(0, DESCRIBED, 2)
            plain = _mixed(described[one].blocks, described[other].blocks, random)
            quantised = _mixed(words[one], words[other], random)
            _add_row(session, number, shape_id, described[one])
            key = {"shape_id": shape_id}
            by = key | {"fingerprint": vocabulary.fingerprint}
            session.execute(insert(PlainBlockRow), _rows(by, plain))
            session.execute(
                insert(QuantisedBlockRow), _rows(key | {"vocabulary_id": vocabulary.id}, quantised)
            )
            if number < WITH_FILES:
                save_signatures(library.files, shape_id, described[one].signatures)
            if number >= n_shapes - WITH_FILES:  # the newest, which are seen first
                library.files.put(derived_key(shape_id, THUMBNAIL), described[one].thumbnail)
    library.close()
    return ids


def _mixed(one: Blocks, other: Blocks, random: np.random.Generator) -> dict[str, SingleArray]:
    """Return a mean of two shapes' blocks, by random weights, with noise; zeros stay."""
    share = random.uniform()

    def mixed(name: str) -> SingleArray:
        exact = share * one[name] + (1.0 - share) * other[name]
        return np.asarray(exact * (1.0 + NOISE * random.normal(size=exact.shape)), np.float32)

    return {name: mixed(name) for name in one}


def _rows(key: Mapping[str, str], blocks: Blocks) -> list[dict[str, Any]]:
    return [{**key, "name": name, "data": encode_block(name, block)} for name, block in blocks.items()]


def _add_row(session: Session, number: int, shape_id: str, like: Description) -> None:
    state, moment = lock_state(session), now()
    state.revision += 1
    session.add(
        ShapeRow(
            id=shape_id,
            name=f"made {number}",
            status=Status.READY,
            created_at=moment,
            updated_at=moment,
            user_metadata={"kind": "made"},
            sha256=hashlib.sha256(shape_id.encode()).hexdigest(),
            revision=state.revision,
            sequence=state.revision,
            searchable=f"made {number}",
            allow_untextured=False,
            facts=asdict(like.facts),
            fingerprint=like.fingerprint,
            files=[FileRow(position=0, name="made.ply", key=f"uploads/{shape_id}/0", size=1, sha256="0")],
        )
    )
    session.flush()
