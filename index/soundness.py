"""Soundness: whether the rows of a catalogue are what this program could have written.

A database checks types and references. What is left would be noticed later, by every search.
"""

import re
import struct
import zlib

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from index.blocks import block_length, checked_blocks, decode_block
from index.errors import BadBlock, BadVocabulary, DamagedExport
from index.shapes import Status
from index.tables import PlainBlockRow, QuantisedBlockRow, ShapeRow, StateRow, TombstoneRow, VocabularyRow
from index.vocabulary import Vocabulary

_LONGEST = 1 << 20  # numbers in a block; the longest that is made has a few thousand
_AT_ONCE = 500  # rows
_FOLDER = re.compile(r"[0-9a-f]{0,16}")  # a fingerprint, or none


def check_sound(session: Session) -> None:
    """Look at every row once.

    Raises
    ------
    DamagedExport
        With the first thing that is wrong.
    """
    _check_state(session)
    _check_shapes(session)
    _check_vocabularies(session)
    _check_blocks(session)


def _check_state(session: Session) -> None:
    states = session.scalars(select(StateRow)).all()
    if len(states) != 1 or states[0].id != 1:
        raise DamagedExport(f"the table state must have one row with the id 1, it has {len(states)} rows")
    columns = (ShapeRow.revision, ShapeRow.sequence, TombstoneRow.revision)
    newest = max(session.scalar(select(func.max(column))) or 0 for column in columns)
    if states[0].revision < newest:
        raise DamagedExport(f"the library's revision {states[0].revision} is older than some of its shapes")


def _check_shapes(session: Session) -> None:
    columns = (ShapeRow.id, ShapeRow.status, ShapeRow.user_metadata, ShapeRow.facts, ShapeRow.made_in)
    known = set(Status)
    with session.execute(select(*columns), execution_options={"yield_per": _AT_ONCE}) as rows:
        for row in rows:
            if row.status not in known:
                raise DamagedExport(f"the shape {row.id!r:.50} has the unknown state {row.status!r:.50}")
            if not isinstance(row.user_metadata, dict) or not isinstance(row.facts, dict | None):
                raise DamagedExport(f"metadata and facts of the shape {row.id!r:.50} must be JSON objects")
            if not _FOLDER.fullmatch(row.made_in or ""):
                raise DamagedExport(f"the files made of the shape {row.id!r:.50} are in no folder of ours")


def _check_vocabularies(session: Session) -> None:
    for row in session.scalars(select(VocabularyRow)):
        try:
            Vocabulary.from_bytes(row.data)
        except BadVocabulary:
            raise DamagedExport(f"the vocabulary {row.id!r:.50} cannot be read") from None


def _check_blocks(session: Session) -> None:
    plain, words = PlainBlockRow, QuantisedBlockRow
    queries = (
        select(plain.shape_id, plain.name, plain.data, plain.fingerprint.label("kind")),
        select(words.shape_id, words.name, words.data, words.vocabulary_id.label("kind")),
    )
    lengths: dict[tuple[str, str], int] = {}
    for query in queries:
        with session.execute(query, execution_options={"yield_per": _AT_ONCE}) as rows:
            for row in rows:
                length = _length_of(row.data)
                if length is None or lengths.setdefault((row.kind, row.name), length) != length:
                    raise DamagedExport(
                        f"the block {row.name!r:.50} of the shape {row.shape_id!r:.50} is damaged, or its"
                        " length is not that of the others"
                    )


def _length_of(data: bytes) -> int | None:
    """Return the number of values of a sound block; None for another."""
    try:
        if block_length(data) > _LONGEST:
            return None
        return checked_blocks({"": decode_block(data)})[""].size
    except (BadBlock, ValueError, struct.error, zlib.error):
        return None
