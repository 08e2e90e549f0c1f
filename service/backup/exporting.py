"""Export: a whole library as one file, while others go on using it."""

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path

from index.dumping import Belongings, Moment, one_moment
from index.errors import DamagedExport, FileMissing
from index.portable import line_of
from index.shapes import StoredFile
from service.backup.belongings import present_files
from service.backup.layout import FORMAT, HEADER, Header, file_member, table_member
from service.backup.summary import Damage, Summary
from service.backup.writing import ArchiveWriter, writing_archive
from service.library import Library

Progress = Callable[[int, int], None]  # shapes done, of how many


class ShapeChanged(Exception):
    """A shape was removed or sent anew while its files were read."""


class Unreadable(Exception):
    """A file of the library cannot be read; the message is the code."""


@dataclass(kw_only=True)
class Tally:
    """What was written so far."""

    shapes: int = 0
    files: int = 0
    left_out: list[str] = field(default_factory=list)
    damaged: list[Damage] = field(default_factory=list)


def export_library(
    library: Library, path: Path, replace: bool = False, progress: Progress = lambda *_: None
) -> Summary:
    """Write everything that makes a library into one file.

    All rows are of one moment. A shape that is removed or sent anew before its files are written is left
    out whole; a file that is missing or altered although its shape did not change is told, and does not
    keep the rest from being saved.

    Parameters
    ----------
    replace : bool
        Whether a file at ``path`` may be replaced, once the new one is complete.

    Raises
    ------
    FileExistsError
    StorageFull
        Nothing is left behind.
    """
    tally = Tally()
    with writing_archive(path, replace, int(time.time())) as archive, one_moment(library.engine) as moment:
        header = _header(library, moment)
        archive.add(HEADER, [header.to_bytes()])
        for number, shape in enumerate(moment.shapes(), start=1):
            _add_shape(library, archive, shape, tally)
            progress(number, header.counts["shapes"])
        for table, rows in moment.tables(but=tally.left_out):
            archive.add(table_member(table), map(line_of, rows))
        tally.damaged += _damaged_rows(moment)
    return Summary(
        shapes=tally.shapes,
        files=tally.files,
        bytes=path.stat().st_size,
        left_out=tuple(tally.left_out),
        damaged=tuple(tally.damaged),
    )


def _header(library: Library, moment: Moment) -> Header:
    return Header(
        format=FORMAT,
        faience=version("faience"),
        schema=moment.revision,
        fingerprint=library.parameters.fingerprint(),
        exported_at=datetime.now(UTC).isoformat().replace("+00:00", "Z"),
        counts=moment.counts(),
    )


def _add_shape(library: Library, archive: ArchiveWriter, shape: Belongings, tally: Tally) -> None:
    before = archive.mark()
    damaged: list[Damage] = []
    files = present_files(library.files, shape)
    try:
        for key, known in sorted(files.items()):
            code = _add_file(library, archive, shape, key, known)
            if code is not None:
                damaged.append(Damage(code=code, shape=shape.id, what=key))
    except ShapeChanged:
        archive.rewind(before)
        tally.left_out.append(shape.id)
        return
    tally.damaged += damaged
    tally.shapes += 1
    tally.files += len(files) - sum(damage.code != "file_altered" for damage in damaged)


def _add_file(
    library: Library, archive: ArchiveWriter, shape: Belongings, key: str, known: StoredFile | None
) -> str | None:
    """Write one file; return what is wrong with it, if anything is."""
    try:
        written = archive.add(file_member(key), _readable(library, key))
    except Unreadable as error:
        current = library.catalogue.get_many([shape.id]).get(shape.id)
        if current is None or (current.revision, current.made_in) != (shape.revision, shape.made_in):
            raise ShapeChanged from None
        return str(error)
    if known is not None and (written.sha256, written.size) != (known.sha256, known.size):
        return "file_altered"
    return None


def _readable(library: Library, key: str) -> Iterator[bytes]:
    try:
        yield from library.files.pieces(key)
    except FileMissing:
        raise Unreadable("file_missing") from None
    except OSError:  # a failing disk, or rights that are missing
        raise Unreadable("file_unreadable") from None


def _damaged_rows(moment: Moment) -> list[Damage]:
    """Tell now what an import would refuse."""
    try:
        moment.check()
    except DamagedExport as error:
        return [Damage(code="rows_damaged", shape=None, what=str(error))]
    return []
