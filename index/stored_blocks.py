"""Stored blocks: the descriptors of one shape, or of all that are new to an index."""

from collections.abc import Collection, Iterator, Mapping, Sequence

from sqlalchemy import Engine, ScalarSelect, Select, delete, insert, select
from sqlalchemy.orm import Session

from index.arrays import SingleArray
from index.blocks import block_length, decode_block, encode_block
from index.database import reading
from index.errors import FingerprintMismatch, NotReady
from index.rows import shape_row
from index.shapes import Status
from index.tables import PlainBlockRow, QuantisedBlockRow, ShapeRow, VocabularyRow

_AT_ONCE = 500  # shapes in one statement

Blocks = dict[str, SingleArray]


class StoredBlocks:
    """How descriptors are read."""

    _engine: Engine

    def blocks(self, shape_id: str, vocabulary_id: str | None) -> Blocks:
        """Return a ready shape's blocks, those of the vocabulary included; NotReady for another shape."""
        with reading(self._engine) as session:
            if shape_row(session, shape_id).status != Status.READY:
                raise NotReady("this shape has no descriptors")
            return _read(session, [shape_id], vocabulary_id, None)[shape_id]

    def some_blocks(
        self, shape_ids: Sequence[str], vocabulary_id: str, names: Collection[str]
    ) -> dict[str, Blocks]:
        """Return some blocks of a few shapes; a shape that is not there, or not ready, has none."""
        with reading(self._engine) as session:
            return _read(session, shape_ids, vocabulary_id, names)

    def block_rows(
        self,
        vocabulary_id: str | None,
        after_revision: int = 0,
        names: Collection[str] | None = None,
        but: Collection[str] = (),
    ) -> Iterator[tuple[str, Blocks]]:
        """Yield (id, blocks) of every ready shape that changed after a revision, ordered by id.

        One transaction, held until the last row is taken: all rows show the same moment.

        Parameters
        ----------
        vocabulary_id : str or None
            Whose words are joined to the blocks that need none; None for only the latter.
        after_revision : int
            0 for all shapes.
        names : collection of str, optional
            Only these blocks.
        but : collection of str
            Ids of shapes to leave out.
        """
        query = select(ShapeRow.id).where(ShapeRow.status == Status.READY, ShapeRow.revision > after_revision)
        with reading(self._engine) as session:
            shape_ids = [i for i in session.scalars(query.order_by(ShapeRow.id)) if i not in but]
            for start in range(0, len(shape_ids), _AT_ONCE):
                yield from _read(session, shape_ids[start : start + _AT_ONCE], vocabulary_id, names).items()

    def ready_revisions(self) -> dict[str, int]:
        """Return the revision of every ready shape, by id."""
        query = select(ShapeRow.id, ShapeRow.revision).where(ShapeRow.status == Status.READY)
        with reading(self._engine) as session:
            return {row.id: row.revision for row in session.execute(query)}


def write_plain(session: Session, shape_id: str, fingerprint: str, blocks: Mapping[str, SingleArray]) -> None:
    """Replace a shape's blocks that need no vocabulary, of those parameters."""
    table, key = PlainBlockRow, {"shape_id": shape_id, "fingerprint": fingerprint}
    ours = table.fingerprint == fingerprint
    session.execute(delete(table).where(ours, table.shape_id == shape_id))
    for name, block in blocks.items():
        _refuse_other_length(session, select(table.data).where(ours, table.name == name), name, block)
        session.execute(insert(table), {**key, "name": name, "data": encode_block(name, block)})


def delete_blocks(session: Session, shape_id: str, but_fingerprints: Collection[str] = ()) -> None:
    """Delete a shape's blocks, in the words of every vocabulary, but those of some parameters."""
    plain, words = PlainBlockRow, QuantisedBlockRow
    kept = select(VocabularyRow.id).where(VocabularyRow.fingerprint.in_(but_fingerprints))
    session.execute(
        delete(plain).where(plain.shape_id == shape_id, plain.fingerprint.not_in(but_fingerprints))
    )
    session.execute(delete(words).where(words.shape_id == shape_id, words.vocabulary_id.not_in(kept)))


def write_quantised(
    session: Session, shape_id: str, vocabulary_id: str, blocks: Mapping[str, SingleArray]
) -> None:
    """Replace a shape's blocks in the words of one vocabulary."""
    table, key = QuantisedBlockRow, {"shape_id": shape_id, "vocabulary_id": vocabulary_id}
    ours = table.vocabulary_id == vocabulary_id
    session.execute(delete(table).where(ours, table.shape_id == shape_id))
    for name, block in blocks.items():
        _refuse_other_length(session, select(table.data).where(ours, table.name == name), name, block)
        session.execute(insert(table), {**key, "name": name, "data": encode_block(name, block)})


def _refuse_other_length(session: Session, query: Select[bytes], name: str, block: SingleArray) -> None:
    # One vector of another length would stop the search for every shape.
    known = session.scalars(query.limit(1)).first()
    if known is not None and block_length(known) != block.size:
        raise FingerprintMismatch(
            f"block {name!r} has {block.size} numbers, that of the other shapes {block_length(known)}"
        )


def _fingerprint_of(vocabulary_id: str) -> ScalarSelect[str]:
    # Blocks of other parameters may lie beside these while shapes are described anew.
    query = select(VocabularyRow.fingerprint).where(VocabularyRow.id == vocabulary_id)
    return query.scalar_subquery()


def _read(
    session: Session, shape_ids: Sequence[str], vocabulary_id: str | None, names: Collection[str] | None
) -> dict[str, Blocks]:
    found: dict[str, Blocks] = {shape_id: {} for shape_id in shape_ids}
    plain, words = PlainBlockRow, QuantisedBlockRow
    free = select(plain.shape_id, plain.name, plain.data).where(plain.shape_id.in_(shape_ids))
    if vocabulary_id is None:
        own = free.join(ShapeRow, ShapeRow.id == plain.shape_id)
        free = own.where(plain.fingerprint == ShapeRow.fingerprint)
    else:
        free = free.where(plain.fingerprint == _fingerprint_of(vocabulary_id))
    queries = [(free, plain.name)]
    if vocabulary_id is not None:
        ours = (words.vocabulary_id == vocabulary_id, words.shape_id.in_(shape_ids))
        queries.append((select(words.shape_id, words.name, words.data).where(*ours), words.name))
    for query, column in queries:
        wanted = query if names is None else query.where(column.in_(names))
        for shape_id, name, data in session.execute(wanted):
            found[shape_id][name] = decode_block(data)
    return found
