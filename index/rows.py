"""Rows ↔ values: the table's shape becomes the frozen one that leaves this package."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from sqlalchemy.orm import Session

from index.errors import ShapeNotFound
from index.shapes import Shape, Status, StoredFile
from index.tables import FileRow, ShapeRow


def shape_row(session: Session, shape_id: str) -> ShapeRow:
    """Return a shape's row; ShapeNotFound where there is none."""
    row = session.get(ShapeRow, shape_id)
    if row is None:
        raise ShapeNotFound(f"no shape has the id {shape_id!r}")
    return row


def shape_of(row: ShapeRow) -> Shape:
    """Return the value of a row."""
    return Shape(
        id=row.id,
        name=row.name,
        status=Status(row.status),
        created_at=row.created_at,
        updated_at=row.updated_at,
        metadata=row.user_metadata,
        sha256=row.sha256,
        revision=row.revision,
        allow_untextured=row.allow_untextured,
        files=stored_files(row),
        facts=row.facts,
        error_code=row.error_code,
        error_detail=row.error_detail,
        fingerprint=row.fingerprint,
        made_in=row.made_in,
    )


def stored_files(row: ShapeRow) -> tuple[StoredFile, ...]:
    """Return a shape's files in the order of the upload."""
    return tuple(
        StoredFile(name=file.name, key=file.key, size=file.size, sha256=file.sha256) for file in row.files
    )


def file_rows(files: Sequence[StoredFile]) -> list[FileRow]:
    """Return rows for files, in their order."""
    return [
        FileRow(position=position, name=file.name, key=file.key, size=file.size, sha256=file.sha256)
        for position, file in enumerate(files)
    ]


def describe_for_search(row: ShapeRow) -> None:
    """Renew the text in which the list's filter looks."""
    row.searchable = folded("\n".join([row.name, *_texts(row.user_metadata)]))


def folded(text: str) -> str:
    """Return a text whose capitals do not matter, and that any database accepts."""
    return storable(text.casefold())


def storable(text: str) -> str:
    """Return a text without the signs that a database refuses."""
    return text.encode("utf-8", "replace").decode().replace("\0", " ")


def _texts(value: Any) -> Iterator[str]:
    if isinstance(value, Mapping):
        for part in value.values():
            yield from _texts(part)
    elif isinstance(value, list | tuple):
        for part in value:
            yield from _texts(part)
    elif value is not None:
        yield str(value)
