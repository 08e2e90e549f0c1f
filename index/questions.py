"""Questions: what a search asks of the catalogue besides the index, in few statements and without an ORM."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from sqlalchemy import BindParameter, Connection, Engine, Row, bindparam, select, true, union_all

from index.arrays import SingleArray
from index.blocks import decode_block
from index.database import looking
from index.errors import NotReady, ShapeNotFound
from index.shapes import Shape, Status, StoredFile
from index.tables import FileRow, PlainBlockRow, QuantisedBlockRow, ShapeRow, StateRow

_AT_ONCE = 500  # ids in one statement; SQLite allows 32 766 values

# Made once: SQLAlchemy needs longer to put a statement together than SQLite to answer it. Tables instead of
# mapped classes: their rows are tuples.
_shapes, _files, _state = ShapeRow.__table__, FileRow.__table__, StateRow.__table__
_plain, _words = PlainBlockRow.__table__, QuantisedBlockRow.__table__
_SHAPE_ID: BindParameter[str] = bindparam("shape_id")
_SHAPE_IDS: BindParameter[list[str]] = bindparam("shape_ids", expanding=True)
_NAMES: BindParameter[list[str]] = bindparam("names", expanding=True)
_QUERY = (
    select(_shapes.c.status, _state.c.vocabulary_id)
    .join_from(_shapes, _state, true())
    .where(_shapes.c.id == _SHAPE_ID)
)
_QUERY_BLOCKS = union_all(
    select(_plain.c.name, _plain.c.data).where(_plain.c.shape_id == _SHAPE_ID, _plain.c.name.in_(_NAMES)),
    select(_words.c.name, _words.c.data).where(
        _words.c.shape_id == _SHAPE_ID,
        _words.c.vocabulary_id == bindparam("vocabulary_id"),
        _words.c.name.in_(_NAMES),
    ),
)
_ONE_BLOCK = select(_plain.c.shape_id, _plain.c.data).where(
    _plain.c.shape_id.in_(_SHAPE_IDS), _plain.c.name == bindparam("name")
)
_SHAPES = select(_shapes).where(_shapes.c.id.in_(_SHAPE_IDS))
_FILES = (
    select(_files.c.shape_id, _files.c.name, _files.c.key, _files.c.size, _files.c.sha256)
    .where(_files.c.shape_id.in_(_SHAPE_IDS))
    .order_by(_files.c.shape_id, _files.c.position)
)


@dataclass(frozen=True, kw_only=True, eq=False)
class QueryBlocks:
    """A stored shape as a query."""

    vocabulary_id: str | None  # the active one, whose words the blocks are in
    blocks: Mapping[str, SingleArray]  # those asked for that there are


class Questions:
    """How a search reads, each method in one transaction."""

    _engine: Engine

    def query_blocks(self, shape_id: str, names: Collection[str]) -> QueryBlocks:
        """Return some blocks of a ready shape, in the words of the active vocabulary.

        Raises
        ------
        ShapeNotFound, NotReady
        """
        with looking(self._engine) as connection:
            row = connection.execute(_QUERY, {"shape_id": shape_id}).one_or_none()
            if row is None:
                raise ShapeNotFound(f"no shape has the id {shape_id!r}")
            if row.status != Status.READY:
                raise NotReady(f"the shape is {row.status}; only a ready one can be compared")
            wanted = {"shape_id": shape_id, "vocabulary_id": row.vocabulary_id, "names": list(names)}
            found = {name: decode_block(data) for name, data in connection.execute(_QUERY_BLOCKS, wanted)}
        return QueryBlocks(vocabulary_id=row.vocabulary_id, blocks=found)

    def one_block(self, shape_ids: Sequence[str], name: str) -> dict[str, SingleArray]:
        """Return a block that needs no vocabulary, of those shapes that have it."""
        with looking(self._engine) as connection:
            rows = connection.execute(_ONE_BLOCK, {"shape_ids": list(shape_ids), "name": name}).all()
        return {shape_id: decode_block(data) for shape_id, data in rows}

    def get_many(self, shape_ids: Iterable[str]) -> dict[str, Shape]:
        """Return the shapes that exist among `shape_ids`, by id."""
        wanted = list(dict.fromkeys(shape_ids))
        found: dict[str, Shape] = {}
        with looking(self._engine) as connection:
            for start in range(0, len(wanted), _AT_ONCE):
                found.update(_shapes_of(connection, wanted[start : start + _AT_ONCE]))
        return found


def _shapes_of(connection: Connection, shape_ids: list[str]) -> dict[str, Shape]:
    some = {"shape_ids": shape_ids}
    files: dict[str, list[StoredFile]] = {shape_id: [] for shape_id in shape_ids}
    for shape_id, name, key, size, sha256 in connection.execute(_FILES, some):
        files[shape_id].append(StoredFile(name=name, key=key, size=size, sha256=sha256))
    return {row.id: _shape_of(row, files[row.id]) for row in connection.execute(_SHAPES, some)}


def _shape_of(row: Row[Any], files: list[StoredFile]) -> Shape:
    return Shape(
        id=row.id,
        name=row.name,
        status=Status(row.status),
        created_at=row.created_at,
        updated_at=row.updated_at,
        metadata=row.metadata,
        sha256=row.sha256,
        revision=row.revision,
        allow_untextured=row.allow_untextured,
        files=tuple(files),
        facts=row.facts,
        error_code=row.error_code,
        error_detail=row.error_detail,
    )
