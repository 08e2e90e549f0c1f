"""Import: a library without shapes becomes the one that was exported."""

import errno
import fcntl
import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, cast

from index.dumping import one_moment
from index.errors import CatalogueBusy, DamagedExport
from index.files import FileStore, check_key
from index.replacing import check_empty, replace_library
from index.staging import Staging
from service.backup.belongings import made_prefix, needed_files
from service.backup.checking import checked_archive
from service.backup.layout import FILES, Part, part_of
from service.backup.members import Members
from service.backup.reading import MemberStream, Told, members_of
from service.backup.summary import Damage, Summary
from service.backup.writing import Written
from service.jobs.sweeping import HOUR
from service.library import Library
from service.storage import derived_key

_LONG = HOUR / 2  # seconds; well before files count as left over
_IMPOSSIBLE = frozenset({errno.ENAMETOOLONG, errno.ENOTDIR, errno.EISDIR, errno.EEXIST})

Progress = Callable[[str, int, int], None]  # what is done, bytes of the archive so far, of how many


@dataclass(frozen=True, kw_only=True)
class Counted:
    """What the rows of an archive say, compared with its files."""

    shapes: int
    damaged: tuple[Damage, ...]  # files that were missing or altered when the library was exported


def import_library(library: Library, path: Path, progress: Progress = lambda *_: None) -> Summary:
    """Fill a library that has no shapes; the archive is checked as a whole first.

    Files come first, durably, then all rows in one transaction. Killed on the way, the library still has no
    shapes, and importing again works; the files left over are swept as those of any cut upload.

    Raises
    ------
    LibraryNotEmpty, DamagedExport, NewerFormat, StorageFull, StorageUnreachable, CatalogueBusy
        Nothing was changed.
    """
    _check_empty(library)
    size = path.stat().st_size

    def told(what: str) -> Told:
        return lambda done: progress(what, done, size)

    with (
        _alone(library),
        library.incoming.scratch() as folder,
        path.open("rb") as file,
        Members(folder) as members,
    ):
        archive = cast("BinaryIO", file)
        with checked_archive(archive, folder, members, told("Checking")) as staging:
            counted = _compare(staging, members)
            files = _bring_in(library, archive, members, staging, told("Importing"))
    return Summary(shapes=counted.shapes, files=files, bytes=size, damaged=counted.damaged)


def _check_empty(library: Library) -> None:
    check_empty(sum(library.catalogue.counts().values()))


@contextmanager
def _alone(library: Library) -> Iterator[None]:
    """Keep other imports out: one that fails deletes files that the other may have brought, too."""
    with (library.incoming.folder.parent / ".import").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise CatalogueBusy("another import into this library is running") from None
        yield


def _compare(staging: Staging, members: Members) -> Counted:
    """Find each shape's files.

    Raises
    ------
    DamagedExport
        A file belongs to no shape or to several, or a shape has an id that we cannot have made.
    """
    shapes, damaged = 0, []
    with one_moment(staging.engine) as moment:
        for shapes, shape in enumerate(moment.shapes(), start=1):  # noqa: B007 - the last number is the count
            _check_id(shape.id)
            for key, known in needed_files(shape).items():
                found = members.claim(key)
                if found is None:
                    damaged.append(Damage(code="file_missing", shape=shape.id, what=key))
                elif known is not None and (found.sha256, found.size) != (known.sha256, known.size):
                    damaged.append(Damage(code="file_altered", shape=shape.id, what=key))
            members.claim_below(made_prefix(shape.id))
    stranger = members.unclaimed()
    if stranger is not None:
        raise DamagedExport(f"{stranger!r:.100} belongs to no shape of the export")
    return Counted(shapes=shapes, damaged=tuple(damaged))


def _check_id(shape_id: str) -> None:
    try:
        check_key(derived_key(shape_id, "x"))
    except ValueError:
        raise DamagedExport(f"{shape_id!r:.100} is no id of a shape") from None


def _bring_in(library: Library, archive: BinaryIO, members: Members, staging: Staging, told: Told) -> int:
    """Put files and rows in their places; return the number of files."""
    started = time.monotonic()
    try:
        count = _put_files(library.files, archive, members, told)
        if time.monotonic() - started > _LONG:
            _renew(library.files, archive, members)
        library.files.flush(_keys(members))
        # What is kept of an index here may show a later moment of the very library that comes.
        shutil.rmtree(library.settings.data_dir / "index", ignore_errors=True)
        replace_library(library.engine, staging.engine)
    except BaseException:
        with suppress(Exception):  # what cannot be deleted is swept later
            _take_back(library, members)
        raise
    return count


def _put_files(
    files: FileStore,
    archive: BinaryIO,
    members: Members,
    told: Told,
    wanted: Callable[[str], bool] = lambda _: True,
) -> int:
    count = 0
    for stream in members_of(archive, told):
        key = stream.name.removeprefix(FILES)
        if part_of(stream.name) is not Part.FILE or not wanted(key):
            continue
        _put_file(files, key, stream)
        if Written(size=stream.size, sha256=stream.digest()) != members.find(stream.name):
            raise DamagedExport(f"{stream.name!r:.100} was altered during the import")
        count += 1
    return count


def _put_file(files: FileStore, key: str, stream: MemberStream) -> None:
    try:
        files.put_stream(key, stream, flushed=False)
    except OSError as error:
        if error.errno in _IMPOSSIBLE:
            raise DamagedExport(f"no file can lie under {key!r:.100}") from None
        raise


def _renew(files: FileStore, archive: BinaryIO, members: Members) -> None:
    """Make the files young again: a worker beside us sweeps old ones that no row needs yet."""
    swept = {key for key in _keys(members) if not files.touch(key)}
    if swept:
        _put_files(files, archive, members, lambda _: None, swept.__contains__)


def _take_back(library: Library, members: Members) -> None:
    """Delete what was put; not where somebody filled the library meanwhile, who may need it."""
    _check_empty(library)
    for key in _keys(members):
        library.files.delete(key)


def _keys(members: Members) -> Iterator[str]:
    for name, _ in members.all():
        if part_of(name) is Part.FILE:
            yield name.removeprefix(FILES)
