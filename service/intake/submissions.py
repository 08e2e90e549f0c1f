"""An upload that has arrived whole, as files on disk, before anything is decided about it."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Any

from service.jobs.describing import FilesOnDisk
from worker.errors import Code, MeshError
from worker.reading.upload import Upload

MESHES = (".ply", ".obj", ".zip")  # what gives a shape its name


@dataclass(frozen=True, kw_only=True)
class ReceivedFile:
    """One file of an upload, in a temporary place."""

    name: str  # relative path as sent, with forward slashes
    path: Path  # where its bytes are now
    size: int  # bytes
    sha256: str  # hexadecimal, of its content


@dataclass(frozen=True, kw_only=True)
class Submission:
    """What a user sent, complete."""

    files: tuple[ReceivedFile, ...]  # at least one, names all different
    name: str | None = None  # None: the stem of the mesh file
    metadata: Mapping[str, Any] = field(default_factory=dict)
    allow_untextured: bool = False  # accept where a named texture is missing

    @property
    def contents(self) -> FilesOnDisk:
        """Name → bytes, each read when it is asked for."""
        return FilesOnDisk({file.name: file.path for file in self.files})

    def upload(self) -> Upload:
        """Return the form that `worker` reads."""
        return Upload(files=self.contents, allow_untextured=self.allow_untextured)

    def content_hash(self) -> str:
        """Return the SHA-256 that tells whether the same content is known.

        Neither the order of the files counts nor what the mesh itself is called; others are named by it.
        """
        files = sorted((_place(file.name), file.sha256) for file in self.files)
        text = json.dumps([files, self.allow_untextured], ensure_ascii=False, separators=(",", ":"))
        return hashlib.sha256(text.encode()).hexdigest()

    def display_name(self) -> str:
        """Return the name given, or the stem of the mesh file, or of the archive."""
        if self.name:
            return self.name
        paths = [PurePosixPath(file.name) for file in self.files]
        meshes = [path for path in paths if path.suffix.lower() in MESHES]
        return (meshes or paths)[0].stem


def _place(name: str) -> str:
    """Return a file's name, or for a mesh the folder and the kind alone."""
    path = PurePosixPath(name)
    return str(path.with_name(path.suffix.lower())) if path.suffix.lower() in MESHES else name


def receive_paths(paths: Mapping[str, Path], **details: Any) -> Submission:
    """Return the submission of files that already lie on this machine.

    Parameters
    ----------
    paths : Mapping[str, Path]
        Name as it should be stored → file.
    **details
        Further fields of `Submission`.
    """
    files = []
    for name, path in paths.items():
        with path.open("rb") as stream:
            digest = hashlib.file_digest(stream, "sha256").hexdigest()
        files.append(ReceivedFile(name=safe_name(name), path=path, size=path.stat().st_size, sha256=digest))
    return Submission(files=tuple(files), **details)


def safe_name(name: str) -> str:
    """Return a file's relative name with forward slashes.

    Raises
    ------
    MeshError
        ``unsafe_reference`` where it is absolute, climbs, is empty or holds control characters.
    """
    plain = name.replace("\\", "/")
    parts = [part for part in plain.split("/") if part not in ("", ".")]
    drive = ":" in plain.split("/")[0]
    if not parts or plain.startswith("/") or drive or ".." in parts or not plain.isprintable():
        raise MeshError(Code.UNSAFE_REFERENCE, f"the file name {name!r} is not a plain relative path")
    if len(plain) > 1_000:
        raise MeshError(Code.UNSAFE_REFERENCE, f"a file name has {len(plain)} characters, at most 1000")
    return "/".join(parts)
