"""Checking an archive as a whole, before anything of it comes into a library."""

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import zip_longest
from pathlib import Path
from typing import BinaryIO

from index.errors import DamagedExport
from index.files import check_key
from index.portable import LONGEST_LINE
from index.staging import Staging
from service.backup.layout import FILES, HEADER, LONGEST_HEADER, ROWS, TABLES, Header, Part, part_of
from service.backup.members import Members
from service.backup.reading import MemberStream, Told, members_of
from service.backup.writing import Written

_ONCE = (Part.HEADER, Part.SUMS)
_LONGEST_SUM = 1 << 12  # bytes of a line of SHA256SUMS


@contextmanager
def checked_archive(file: BinaryIO, folder: Path, members: Members, told: Told) -> Iterator[Staging]:
    """Read a whole archive; yield its rows, in a catalogue of this version's schema.

    Parameters
    ----------
    folder : Path
        Where the rows may lie meanwhile.
    members : Members
        Empty; afterwards it lists the archive.

    Raises
    ------
    DamagedExport, NewerFormat
    """
    streams = _in_order(file, told)
    with Staging(folder, _header(next(streams, None), members).schema) as staging:
        complete = False
        for stream in streams:
            complete = part_of(stream.name) is Part.SUMS
            _take(stream, staging, members)
        if not complete:
            raise DamagedExport("the export ends before its checksums: it was cut")
        staging.finish()
        yield staging


def _in_order(file: BinaryIO, told: Told) -> Iterator[MemberStream]:
    """Yield the members; refuse one that comes after a later part."""
    last = Part.HEADER
    for number, stream in enumerate(members_of(file, told)):
        part = part_of(stream.name)
        if part < last or (part == last and part in _ONCE and number):
            raise DamagedExport(f"the member {stream.name!r:.100} stands in a wrong place")
        last = part
        yield stream


def _header(stream: MemberStream | None, members: Members) -> Header:
    if stream is None or part_of(stream.name) is not Part.HEADER or stream.size > LONGEST_HEADER:
        raise DamagedExport(f"this is no export of Faience: it does not begin with {HEADER}")
    header = Header.from_bytes(stream.read(stream.size))
    _note(stream, members)
    return header


def _take(stream: MemberStream, staging: Staging, members: Members) -> None:
    part = part_of(stream.name)
    if part is Part.SUMS:
        _compare(stream, members)
        return
    if part is Part.TABLE:
        staging.load(stream.name.removeprefix(TABLES).removesuffix(ROWS), stream.lines(LONGEST_LINE))
    else:
        _check_key(stream.name.removeprefix(FILES))
    _note(stream, members)


def _note(stream: MemberStream, members: Members) -> None:
    stream.pass_over()
    members.add(stream.name, Written(size=stream.size, sha256=stream.digest()))


def _check_key(key: str) -> None:
    try:
        check_key(key)
    except ValueError:
        raise DamagedExport(f"the export holds a file under {key!r:.100}, which is no key of ours") from None


def _compare(stream: MemberStream, members: Members) -> None:
    """Compare every member with its line in SHA256SUMS, which has them in the same order."""
    for line, noted in zip_longest(stream.lines(_LONGEST_SUM), members.all()):
        if noted is None:
            raise DamagedExport(f"the checksums name a member that is not here: {line!r:.200}")
        name, written = noted
        if line != f"{written.sha256}  {name}\n".encode():
            raise DamagedExport(f"the checksum of {name!r:.100} is wrong: it was altered")
