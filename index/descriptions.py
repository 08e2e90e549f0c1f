"""Descriptions: what a worker found out about a shape, stored once, or why it found nothing."""

from collections.abc import Mapping
from typing import Any

import numpy.typing as npt
from sqlalchemy import Engine
from sqlalchemy.orm import Session

from index.blocks import checked_blocks
from index.database import writing
from index.deliveries import announce
from index.errors import BadBlock, FingerprintMismatch, UnknownVocabulary, VocabularyChanged
from index.jobs import Job, end_job
from index.renewed import keep_failure
from index.revisions import lock_state, touch
from index.rows import shape_of, shape_row
from index.shapes import Shape, Status
from index.stored_blocks import delete_blocks, write_plain, write_quantised
from index.tables import StateRow, VocabularyRow


class Descriptions:
    """How a worker's results come in."""

    _engine: Engine

    def record_ready(
        self,
        job: Job,
        *,
        facts: Mapping[str, Any],
        fingerprint: str,
        blocks: Mapping[str, npt.ArrayLike],
        quantised: Mapping[str, npt.ArrayLike],
        vocabulary_id: str,
    ) -> Shape:
        """Store a description and end the job; the shape is found by searches from now on.

        Parameters
        ----------
        job : Job
            As claimed.
        facts : mapping
            About the mesh; JSON.
        fingerprint : str
            Of the parameters that made the blocks.
        blocks, quantised : mapping of str to (n,) arrays
            Blocks free of a vocabulary, and those in its words; float32, finite.
        vocabulary_id : str
            The active vocabulary or, while shapes are described anew, the next one; then the shape is
            found once that is active.

        Raises
        ------
        LeaseLost
            The job was taken by another worker, or the shape was removed.
        VocabularyChanged
            Another vocabulary is active: quantise again and record again.
        FingerprintMismatch
            The vocabulary belongs to other parameters, or a block's length to other shapes.
        BadBlock
            A block is not a finite vector, or there is none in the vocabulary's words.
        """
        plain, words = checked_blocks(blocks), checked_quantised(quantised)
        with writing(self._engine) as session:
            state = lock_state(session)
            end_job(session, job, Status.READY)
            row = shape_row(session, job.shape_id)
            check_vocabulary(session, state, vocabulary_id, fingerprint)
            delete_blocks(session, row.id)  # of an earlier time at which it was ready
            if row.made_in is not None:
                keep_failure(session, row.id, row.made_in, "replaced", "by another description")  # tidied up
            write_plain(session, row.id, fingerprint, plain)
            write_quantised(session, row.id, vocabulary_id, words)
            row.status, row.facts, row.fingerprint = Status.READY, dict(facts), fingerprint
            row.made_in = None
            row.error_code = row.error_detail = None
            touch(session, row)
            announce(session, row.id, Status.READY, row.updated_at)
            return shape_of(row)

    def record_failed(self, job: Job, *, code: str, detail: str) -> Shape:
        """Store why there is no description and end the job; LeaseLost as for `record_ready`."""
        with writing(self._engine) as session:
            lock_state(session)
            end_job(session, job, code)
            row = shape_row(session, job.shape_id)
            row.status, row.error_code, row.error_detail = Status.FAILED, code, detail
            touch(session, row)
            announce(session, row.id, Status.FAILED, row.updated_at)
            return shape_of(row)


def checked_quantised(quantised: Mapping[str, npt.ArrayLike]) -> dict[str, npt.NDArray[Any]]:
    """Return blocks in a vocabulary's words, checked; without any a shape would count as missing."""
    if not quantised:
        raise BadBlock("there is no block in the vocabulary's words")
    return dict(checked_blocks(quantised))


def known_vocabulary(session: Session, vocabulary_id: str) -> VocabularyRow:
    """Return a vocabulary's row; UnknownVocabulary where there is none."""
    row = session.get(VocabularyRow, vocabulary_id)
    if row is None:
        raise UnknownVocabulary(f"no vocabulary has the id {vocabulary_id!r}")
    return row


def check_fingerprint(vocabulary: VocabularyRow, fingerprint: str | None) -> None:
    """Refuse to mix descriptors of other parameters with a vocabulary."""
    if vocabulary.fingerprint != fingerprint:
        raise FingerprintMismatch(
            f"vocabulary {vocabulary.id} belongs to the parameters {vocabulary.fingerprint},"
            f" the descriptors to {fingerprint}"
        )


def check_vocabulary(session: Session, state: StateRow, vocabulary_id: str, fingerprint: str) -> None:
    """Refuse a vocabulary of other parameters, or one that is not active and not the next one."""
    check_fingerprint(known_vocabulary(session, vocabulary_id), fingerprint)
    if vocabulary_id not in (state.vocabulary_id, state.next_vocabulary_id):
        raise VocabularyChanged(f"the active vocabulary is {state.vocabulary_id}, not {vocabulary_id}")
