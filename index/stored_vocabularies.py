"""Stored vocabularies: several beside each other, one of them active, changed for all shapes at once."""

from collections.abc import Mapping

import numpy.typing as npt
from sqlalchemy import ColumnElement, Engine, Select, delete, exists, select
from sqlalchemy.orm import Session

from index.database import reading, writing
from index.descriptions import check_fingerprint, checked_quantised, known_vocabulary
from index.errors import FingerprintMismatch, NotReady
from index.revisions import lock_state, next_revision, now, touch
from index.rows import shape_row
from index.shapes import Status
from index.stored_blocks import write_quantised
from index.tables import QuantisedBlockRow, ShapeRow, StateRow, VocabularyRow
from index.vocabulary import Vocabulary


class Vocabularies:
    """How a library changes its vocabulary while queries go on with the old one."""

    _engine: Engine

    def active_vocabulary(self) -> Vocabulary | None:
        """Return the vocabulary that searches use; None before the first."""
        query = select(VocabularyRow.data).join(StateRow, StateRow.vocabulary_id == VocabularyRow.id)
        with reading(self._engine) as session:
            data = session.scalars(query).one_or_none()
        return None if data is None else Vocabulary.from_bytes(data)

    def add_vocabulary(self, vocabulary: Vocabulary) -> None:
        """Keep a vocabulary, not yet active; a known one is left as it is."""
        with writing(self._engine) as session:
            lock_state(session)
            add_row(session, vocabulary)

    def vocabulary(self, vocabulary_id: str) -> Vocabulary:
        """Return a vocabulary, active or not; UnknownVocabulary where there is none."""
        with reading(self._engine) as session:
            return Vocabulary.from_bytes(known_vocabulary(session, vocabulary_id).data)

    def missing_from(self, vocabulary_id: str, limit: int) -> list[str]:
        """Return up to `limit` ids of ready shapes that have no blocks in these words yet."""
        with reading(self._engine) as session:
            known_vocabulary(session, vocabulary_id)
            return list(session.scalars(_missing(vocabulary_id).order_by(ShapeRow.id).limit(limit)))

    def add_quantised(self, shape_id: str, vocabulary_id: str, blocks: Mapping[str, npt.ArrayLike]) -> None:
        """Store a ready shape's blocks in the words of a vocabulary, replacing earlier ones.

        Raises
        ------
        ShapeNotFound, NotReady
            The shape was removed meanwhile, or has no descriptors.
        FingerprintMismatch
            The shape was described with other parameters than the vocabulary's.
        """
        words = checked_quantised(blocks)
        with writing(self._engine) as session:
            state = lock_state(session)
            row = shape_row(session, shape_id)
            if row.status != Status.READY:
                raise NotReady("this shape has no descriptors")
            check_fingerprint(known_vocabulary(session, vocabulary_id), row.fingerprint)
            write_quantised(session, shape_id, vocabulary_id, words)
            if state.vocabulary_id == vocabulary_id:
                touch(session, row)  # indexes hold the earlier blocks

    def activate(self, vocabulary_id: str) -> bool:
        """Make a vocabulary the active one, for all shapes at once.

        Returns
        -------
        bool
            False, and nothing is changed, while a ready shape lacks its blocks. True afterwards:
            every index is built anew, and blocks in the words of other vocabularies are gone, but those
            of the one to come where shapes are described anew.

        Raises
        ------
        FingerprintMismatch
            Ready shapes were described with other parameters.
        """
        with writing(self._engine) as session:
            state = lock_state(session)
            vocabulary = known_vocabulary(session, vocabulary_id)
            if state.vocabulary_id == vocabulary_id:
                return True
            if session.scalars(_foreign(vocabulary).limit(1)).first() is not None:
                raise FingerprintMismatch(f"shapes were described with other parameters than {vocabulary_id}")
            if session.scalars(_missing(vocabulary_id).limit(1)).first() is not None:
                return False
            state.vocabulary_id = vocabulary_id
            state.epoch += 1
            next_revision(session)
            kept = {vocabulary_id, state.next_vocabulary_id or vocabulary_id}
            session.execute(delete(QuantisedBlockRow).where(QuantisedBlockRow.vocabulary_id.not_in(kept)))
            return True


def add_row(session: Session, vocabulary: Vocabulary) -> None:
    """Keep a vocabulary; a known one is left as it is."""
    if session.get(VocabularyRow, vocabulary.id) is None:
        session.add(
            VocabularyRow(
                id=vocabulary.id,
                fingerprint=vocabulary.fingerprint,
                data=vocabulary.to_bytes(),
                created_at=now(),
            )
        )


def _missing(vocabulary_id: str) -> Select[str]:
    words = QuantisedBlockRow
    has: ColumnElement[bool] = exists().where(
        words.shape_id == ShapeRow.id, words.vocabulary_id == vocabulary_id
    )
    return select(ShapeRow.id).where(ShapeRow.status == Status.READY, ~has)


def _foreign(vocabulary: VocabularyRow) -> Select[str]:
    ready = ShapeRow.status == Status.READY
    return select(ShapeRow.id).where(ready, ShapeRow.fingerprint != vocabulary.fingerprint)
