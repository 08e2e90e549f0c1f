"""Questions: what a search asks of the catalogue besides the index, in few statements and without an ORM."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

from sqlalchemy import BindParameter, Engine, Select, bindparam, select, true
from sqlalchemy.engine.interfaces import DBAPICursor

from index.arrays import SingleArray
from index.blocks import decode_block
from index.database import looking
from index.errors import DescriptionsChanging, NotReady, ShapeNotFound, VocabularyChanged
from index.prepared import Prepared, PreparedLists, listed
from index.shapes import Shape, Status, StoredFile
from index.tables import FileRow, PlainBlockRow, QuantisedBlockRow, ShapeRow, StateRow, VocabularyRow

_AT_ONCE = 500  # ids in one statement; SQLite allows 32 766 values

_shapes, _files, _state = ShapeRow.__table__, FileRow.__table__, StateRow.__table__
_plain, _words = PlainBlockRow.__table__, QuantisedBlockRow.__table__
_vocabularies = VocabularyRow.__table__
_upcoming = _vocabularies.alias("upcoming")
_FIELDS = [field.name for field in fields(Shape) if field.name != "files"]  # columns of the same names
_SHAPE_ID: BindParameter[str] = bindparam("shape_id")
_VOCABULARY_ID: BindParameter[str] = bindparam("vocabulary_id")


@dataclass(frozen=True, kw_only=True, eq=False)
class QueryBlocks:
    """A stored shape as a query."""

    vocabulary_id: str | None  # whose words the blocks are in
    made_in: str | None  # folder of the files that were made of it; see Shape
    blocks: Mapping[str, SingleArray]  # those asked for that there are


class Questions:
    """How a search reads, each method in one transaction."""

    _engine: Engine

    def query_blocks(self, shape_id: str, names: Collection[str]) -> QueryBlocks:
        """Return some blocks of a ready shape, in the words of the active vocabulary.

        While shapes are described anew, those that came meanwhile are in the words of the next one.

        Raises
        ------
        ShapeNotFound, NotReady, DescriptionsChanging
        """
        with looking(self._engine) as cursor:
            rows = self._prepared.query.rows(cursor, {"shape_id": shape_id})
            if not rows:
                raise ShapeNotFound(f"no shape has the id {shape_id!r}")
            ((status, fingerprint, made_in, *vocabularies),) = rows
            if status != Status.READY:
                raise NotReady(f"the shape is {status}; only a ready one can be compared")
            vocabulary_id = _whose_words(fingerprint, *vocabularies)
            wanted = {"shape_id": shape_id, "vocabulary_id": vocabulary_id, "fingerprint": fingerprint}
            found = self._prepared.plain.rows(cursor, wanted, list(names))
            found += self._prepared.words.rows(cursor, wanted, list(names))
        blocks = {name: decode_block(data) for name, data in found}
        return QueryBlocks(vocabulary_id=vocabulary_id, blocks=blocks, made_in=made_in)

    def one_block(self, shape_ids: Sequence[str], name: str, vocabulary_id: str) -> dict[str, SingleArray]:
        """Return a block that needs no vocabulary, of those shapes that have it.

        Parameters
        ----------
        vocabulary_id : str
            Of its parameters the block must be.

        Raises
        ------
        VocabularyChanged
            It is neither the active nor the next one.
        """
        wanted = {"name": name, "vocabulary_id": vocabulary_id}
        with looking(self._engine) as cursor:
            (used,) = self._prepared.used.rows(cursor, {})
            if vocabulary_id not in used:
                raise VocabularyChanged(f"the active vocabulary is {used[0]}, not {vocabulary_id}")
            rows = self._prepared.one_block.rows(cursor, wanted, list(shape_ids))
        return {shape_id: decode_block(data) for shape_id, data in rows}

    def get_many(self, shape_ids: Iterable[str]) -> dict[str, Shape]:
        """Return the shapes that exist among `shape_ids`, by id."""
        wanted = list(dict.fromkeys(shape_ids))
        found: dict[str, Shape] = {}
        with looking(self._engine) as cursor:
            for start in range(0, len(wanted), _AT_ONCE):
                found.update(self._prepared.shapes_of(cursor, wanted[start : start + _AT_ONCE]))
        return found

    @cached_property
    def _prepared(self) -> "_Statements":
        return _Statements(self._engine)


def _whose_words(
    fingerprint: str,
    active: str | None,
    active_for: str | None,
    upcoming: str | None,
    upcoming_for: str | None,
) -> str | None:
    """Return the active vocabulary or, for what was described by the next one's parameters, that."""
    if active is None or fingerprint == active_for:
        return active
    if upcoming is not None and fingerprint == upcoming_for:
        return upcoming
    raise DescriptionsChanging(
        "this shape was described by other parameters than the others, and will be anew"
    )


class _Statements:
    """What is asked, prepared for the engine's kind of database."""

    def __init__(self, engine: Engine) -> None:
        self.query = Prepared(
            select(
                _shapes.c.status,
                _shapes.c.fingerprint,
                _shapes.c.made_in,
                _state.c.vocabulary_id,
                _vocabularies.c.fingerprint,
                _state.c.next_vocabulary_id,
                _upcoming.c.fingerprint,
            )
            .join_from(_shapes, _state, true())
            .outerjoin(_vocabularies, _vocabularies.c.id == _state.c.vocabulary_id)
            .outerjoin(_upcoming, _upcoming.c.id == _state.c.next_vocabulary_id)
            .where(_shapes.c.id == _SHAPE_ID),
            engine.dialect,
        )
        self.used = Prepared(select(_state.c.vocabulary_id, _state.c.next_vocabulary_id), engine.dialect)
        self.plain = PreparedLists(_plain_blocks, engine)
        self.words = PreparedLists(_quantised_blocks, engine)
        self.one_block = PreparedLists(_one_block, engine)
        self.shapes = PreparedLists(_some_shapes, engine)
        self.files = PreparedLists(_files_of, engine)

    def shapes_of(self, cursor: DBAPICursor, shape_ids: list[str]) -> dict[str, Shape]:
        """Return the shapes that exist, by id."""
        files: dict[str, list[StoredFile]] = {shape_id: [] for shape_id in shape_ids}
        for shape_id, name, key, size, sha256 in self.files.rows(cursor, {}, shape_ids):
            files[shape_id].append(StoredFile(name=name, key=key, size=size, sha256=sha256))
        rows = self.shapes.rows(cursor, {}, shape_ids)
        found = {}
        for row in rows:
            named = dict(zip(_FIELDS, row, strict=True))
            named["status"], named["files"] = Status(named["status"]), tuple(files[named["id"]])
            found[named["id"]] = Shape(**named)
        return found


def _list(length: int) -> list[BindParameter[str]]:
    return [bindparam(name) for name in listed(length)]


def _plain_blocks(n_names: int) -> Select[Any]:
    ours = _plain.c.shape_id == _SHAPE_ID, _plain.c.fingerprint == bindparam("fingerprint")
    return select(_plain.c.name, _plain.c.data).where(*ours, _plain.c.name.in_(_list(n_names)))


def _quantised_blocks(n_names: int) -> Select[Any]:
    ours = _words.c.shape_id == _SHAPE_ID, _words.c.vocabulary_id == _VOCABULARY_ID
    return select(_words.c.name, _words.c.data).where(*ours, _words.c.name.in_(_list(n_names)))


def _one_block(n_shapes: int) -> Select[Any]:
    known = select(_vocabularies.c.fingerprint).where(_vocabularies.c.id == _VOCABULARY_ID)
    return select(_plain.c.shape_id, _plain.c.data).where(
        _plain.c.shape_id.in_(_list(n_shapes)),
        _plain.c.fingerprint == known.scalar_subquery(),
        _plain.c.name == bindparam("name"),
    )


def _files_of(n_shapes: int) -> Select[Any]:
    columns = (_files.c.shape_id, _files.c.name, _files.c.key, _files.c.size, _files.c.sha256)
    some = select(*columns).where(_files.c.shape_id.in_(_list(n_shapes)))
    return some.order_by(_files.c.shape_id, _files.c.position)


def _some_shapes(n_shapes: int) -> Select[Any]:
    columns = (_shapes.c[name] for name in _FIELDS)
    return select(*columns).where(_shapes.c.id.in_(_list(n_shapes)))
