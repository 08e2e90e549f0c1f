"""Zip files, unpacked in memory within limits that hold while reading."""

import io
import stat
import zipfile
import zlib
from collections.abc import Iterator

from worker.errors import Code, MeshError
from worker.reading.limits import Limits
from worker.reading.references import normalise
from worker.reading.showing import shown

_PIECE = 1 << 20  # bytes unpacked at a time
_METHODS = {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}
_ENCRYPTED = 0x1
_CENTRAL = b"PK\x01\x02"  # begins each entry of a zip's list
_DAMAGED = "The zip is damaged, or of an unusual kind; pack its files anew."
_ARCHIVES = (".zip", ".7z", ".rar", ".gz", ".tar", ".tgz", ".bz2", ".xz")


def unpack(data: bytes, limits: Limits) -> dict[str, bytes]:
    """Unpack a zip.

    Parameters
    ----------
    data : bytes
        The archive.
    limits : Limits
        The most entries and bytes.

    Returns
    -------
    dict[str, bytes]
        By normalised path; folders, resource forks and hidden files are left out.

    Raises
    ------
    MeshError
        BAD_ARCHIVE, ARCHIVE_TOO_LARGE, UNSAFE_REFERENCE
    """
    try:
        with _open(data, limits) as archive:
            files: dict[str, bytes] = {}
            left = limits.unpacked_bytes
            for name, entry in _entries(archive, limits):
                files[name] = _read(archive, entry, left)
                left -= len(files[name])
            return files
    except (
        zipfile.BadZipFile,
        zlib.error,
        EOFError,
        NotImplementedError,
        RuntimeError,
        ValueError,
        OSError,
    ) as error:
        raise MeshError(Code.BAD_ARCHIVE, _DAMAGED) from error


def list_archive(data: bytes, limits: Limits) -> dict[str, int]:
    """Return the paths of a zip and their announced sizes, checked as `unpack` does, without unpacking.

    Raises
    ------
    MeshError
        BAD_ARCHIVE, ARCHIVE_TOO_LARGE, UNSAFE_REFERENCE
    """
    try:
        with _open(data, limits) as archive:
            return {name: entry.file_size for name, entry in _entries(archive, limits)}
    except (zipfile.BadZipFile, NotImplementedError, ValueError, OSError) as error:
        raise MeshError(Code.BAD_ARCHIVE, _DAMAGED) from error


def _open(data: bytes, limits: Limits) -> zipfile.ZipFile:
    # Counted before the list is read, for a list of millions of entries takes minutes.
    if data.count(_CENTRAL) > limits.archive_entries:
        raise MeshError(Code.ARCHIVE_TOO_LARGE, f"The zip holds more than {limits.archive_entries:,} files.")
    return zipfile.ZipFile(io.BytesIO(data))


def _entries(archive: zipfile.ZipFile, limits: Limits) -> Iterator[tuple[str, zipfile.ZipInfo]]:
    """Yield the files that count, after the whole list is checked."""
    announced = sum(entry.file_size for entry in archive.infolist())
    if announced > limits.unpacked_bytes:
        raise _too_large(limits.unpacked_bytes)
    found: dict[str, zipfile.ZipInfo] = {}
    for entry in archive.infolist():
        name = _checked_name(entry)
        if entry.is_dir() or is_hidden(name):
            continue
        _check_entry(entry, name)
        if name in found:
            raise MeshError(Code.BAD_ARCHIVE, f"The zip holds {shown(name)} twice.")
        found[name] = entry
    yield from found.items()


def _checked_name(entry: zipfile.ZipInfo) -> str:
    name = normalise(entry.filename)
    if name is None or ".." in entry.filename.replace("\\", "/").split("/"):
        raise MeshError(
            Code.UNSAFE_REFERENCE,
            f"The zip holds {shown(entry.filename)}, which would lie outside of its folder.",
        )
    if stat.S_ISLNK(entry.external_attr >> 16):
        raise MeshError(Code.BAD_ARCHIVE, f"{shown(name)} in the zip is a link; send the file itself.")
    return name


def _check_entry(entry: zipfile.ZipInfo, name: str) -> None:
    if entry.flag_bits & _ENCRYPTED:
        raise MeshError(Code.BAD_ARCHIVE, f"{shown(name)} in the zip is locked with a password.")
    if entry.compress_type not in _METHODS:
        raise MeshError(
            Code.BAD_ARCHIVE, f"{shown(name)} in the zip is packed in an unusual way; use plain zip."
        )
    if name.lower().endswith(_ARCHIVES):
        raise MeshError(
            Code.BAD_ARCHIVE, f"The zip holds another archive, {shown(name)}; send the files themselves."
        )


def is_hidden(name: str) -> bool:
    """Return whether a file is one that systems add by themselves, such as ``__MACOSX/._mesh.obj``."""
    parts = name.split("/")
    return (
        parts[0] == "__MACOSX"
        or parts[-1].startswith(".")
        or parts[-1].lower() in {"thumbs.db", "desktop.ini"}
    )


def _read(archive: zipfile.ZipFile, entry: zipfile.ZipInfo, most: int) -> bytes:
    """Unpack one file in pieces: a lying entry would fill the memory at once."""
    unpacked = bytearray()
    with archive.open(entry) as stream:
        while piece := stream.read(_PIECE):
            unpacked += piece
            if len(unpacked) > most:
                raise _too_large(most)
    if len(unpacked) != entry.file_size:
        raise MeshError(
            Code.BAD_ARCHIVE, f"{shown(entry.filename)} unpacks to another size than the zip announces."
        )
    return bytes(unpacked)


def _too_large(most: int) -> MeshError:
    return MeshError(Code.ARCHIVE_TOO_LARGE, f"The zip unpacks to more than {most:,} bytes.")
