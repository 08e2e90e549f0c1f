"""Tar, as far as backups need it: plain files, and not one of the format's many other things.

The standard library's reader follows links, joins sparse files and takes headers of any length into memory;
a backup has none of these, so that whatever has them is refused.
"""

import tarfile
from dataclasses import dataclass

from index.errors import DamagedExport

BLOCK = 512  # bytes; everything in a tar begins at a multiple of these
END = bytes(2 * BLOCK)
_LARGEST_PLAIN = 8**11 - 1  # size that fits the old header; GNU's has room for more
_READABLE = 0o644


@dataclass(frozen=True, kw_only=True)
class Member:
    """What a header says."""

    name: str
    size: int  # bytes


def header_of(member: Member, moment: int) -> bytes:
    """Return the block before a member's content.

    Parameters
    ----------
    moment : int
        Seconds since 1970, shown as the time of its last change.
    """
    info = tarfile.TarInfo(member.name)
    info.size, info.mtime, info.mode = member.size, moment, _READABLE
    plain = member.size <= _LARGEST_PLAIN
    return info.tobuf(tarfile.USTAR_FORMAT if plain else tarfile.GNU_FORMAT, "utf-8", "strict")


def member_of(block: bytes) -> Member | None:
    """Read a header; None for the zeros at the end.

    Raises
    ------
    DamagedExport
        It is no header, or not one of a plain file.
    """
    try:
        info = tarfile.TarInfo.frombuf(block, "utf-8", "strict")
    except tarfile.EOFHeaderError:  # type: ignore[attr-defined] # missing in the stubs
        return None
    except (tarfile.HeaderError, ValueError):
        raise DamagedExport(
            "this is no export of Faience, or it is damaged: a member has no header"
        ) from None
    if info.type != tarfile.REGTYPE or info.size < 0:
        raise DamagedExport(f"the member {info.name!r:.100} is not a plain file")
    return Member(name=info.name, size=info.size)


def padding_of(size: int) -> bytes:
    """Return the zeros after a content of so many bytes."""
    return bytes(-size % BLOCK)
