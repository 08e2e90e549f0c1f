"""ObjectFiles: files in a bucket of object storage (S3), through obstore."""

import hashlib
import io
import time
from collections.abc import Iterable, Iterator
from datetime import timedelta
from itertools import chain
from pathlib import PurePosixPath
from typing import BinaryIO

import obstore

from index.errors import FileMissing, StorageUnreachable
from index.files import KEY, FileFacts, Stream, check_key
from index.object_client import given_endpoint, named_failures, object_client

PIECE = 8 << 20  # bytes of one request; a file that is longer is sent and read in several
AT_ONCE = 4  # requests of one upload
LISTED = 1000  # files of one answer
# What browsers are told that come to a file by its address: to save it, never to show it.
TYPES = {".png": "image/png", ".glb": "model/gltf-binary"}
OTHER = "application/octet-stream"


class ObjectFiles:
    """Files in a bucket, below a prefix.

    Credentials come from the environment of each process that opens it (``AWS_ACCESS_KEY_ID`` …): only the
    addresses are pickled. The SHA-256 of every request's content is signed and sent as S3's checksum, so that
    the server stores what was sent or refuses.

    Parameters
    ----------
    url : str
        ``s3://BUCKET/PREFIX``.
    endpoint : str, optional
        Of the server; that of the environment (``AWS_ENDPOINT_URL`` …), or else Amazon's own.
    """

    def __init__(self, url: str, endpoint: str | None = None) -> None:
        self._url, self._endpoint = url, endpoint or given_endpoint()
        self._store = object_client(url, self._endpoint)

    @property
    def folder(self) -> None:
        """None: the files are elsewhere."""

    def __reduce__(self) -> tuple[type["ObjectFiles"], tuple[str, str | None]]:
        """Pickle the addresses alone: no credentials, no connection."""
        return ObjectFiles, (self._url, self._endpoint)

    def check(self) -> None:
        """Look into the bucket; StorageUnreachable where that fails, BucketMissing where there is none."""
        with named_failures(self._url):
            next(iter(obstore.list(self._store, chunk_size=1)), None)

    def put(self, key: str, data: bytes, *, flushed: bool = True) -> None:  # noqa: ARG002 - always durable
        """Keep `data` under `key`, durably, replacing what was there."""
        self._put(key, data)

    def put_stream(
        self,
        key: str,
        stream: Stream,
        *,
        flushed: bool = True,  # noqa: ARG002 - always durable
    ) -> tuple[int, str]:
        """Keep what `stream` holds; return its size and SHA-256.

        What is longer than a piece is sent in several; they become a file at once, after the last.
        """
        counted = _Counted(stream)
        first = counted.piece()
        if len(first) < PIECE:
            self._put(key, first)
        else:
            self._put(key, chain([first], iter(counted.piece, b"")))
            self._check_whole(key, counted.size)
        return counted.size, counted.digest.hexdigest()

    def flush(self, keys: Iterable[str]) -> None:
        """Do nothing: what was put is durable."""

    def get(self, key: str) -> bytes:
        """Return the whole content; FileMissing where there is none."""
        with named_failures(key):
            return bytes(obstore.get(self._store, check_key(key)).bytes())

    def get_part(self, key: str, start: int, stop: int) -> bytes:
        """Return the bytes from `start` up to `stop`; FileMissing where there is none."""
        with named_failures(key):
            return bytes(obstore.get_range(self._store, check_key(key), start=start, end=stop))

    def pieces(self, key: str) -> Iterator[bytes]:
        """Yield the content; FileMissing where there is none."""
        with named_failures(key):
            found = obstore.get(self._store, check_key(key))
            size = found.meta["size"]
            first = bytes(found.bytes()) if size <= PIECE else b""
        if first:
            yield first
            return
        for start in range(0, size, PIECE):
            yield self.get_part(key, start, min(start + PIECE, size))

    def open(self, key: str) -> BinaryIO:
        """Return the content as a file, in memory; FileMissing where there is none."""
        return io.BytesIO(self.get(key))

    def facts(self, key: str) -> FileFacts:
        """Return what is known of a file; FileMissing where there is none."""
        with named_failures(key):
            found = obstore.head(self._store, check_key(key))
        moment = found["last_modified"].timestamp()
        return FileFacts(
            size=found["size"], changed=moment, tag=found["e_tag"] or f"{moment}-{found['size']}"
        )

    def address(self, key: str, seconds: float) -> str:
        """Return a URL, signed, under which anybody can read the file for so long."""
        return obstore.sign(self._store, "GET", check_key(key), timedelta(seconds=seconds))

    def changed(self, key: str) -> float:
        """Return when a file was written, in seconds since 1970; this moment where it is gone."""
        try:
            return self.facts(key).changed
        except FileMissing:  # removed beside us
            return time.time()

    def changes(self, prefix: str) -> Iterator[tuple[str, float]]:
        """Yield the keys under a folder, in order, each with when it was written."""
        with named_failures(prefix):
            for found in chain.from_iterable(obstore.list(self._store, prefix or None, chunk_size=LISTED)):
                if KEY.fullmatch(found["path"]):
                    yield found["path"], found["last_modified"].timestamp()

    def touch(self, key: str) -> bool:  # noqa: ARG002 - the interface
        """Return False: a file in a bucket grows young only by being put again."""
        return False

    def delete(self, key: str) -> None:
        """Remove one file; absent is fine."""
        with named_failures(key):
            obstore.delete(self._store, check_key(key))

    def delete_all(self, prefix: str) -> None:
        """Remove every file under the folder `prefix`; absent is fine."""
        keys = list(self.keys(check_key(prefix)))
        if keys:
            with named_failures(prefix):
                obstore.delete(self._store, keys)

    def keys(self, prefix: str = "") -> Iterator[str]:
        """Yield the keys under the folder `prefix` (all without one), in order."""
        return (key for key, _ in self.changes(prefix))

    def sweep(self, older_than_seconds: float) -> int:  # noqa: ARG002 - the interface
        """Return 0: a file that was not sent whole never was one."""
        return 0

    def _put(self, key: str, content: bytes | Iterator[bytes]) -> None:
        kind = TYPES.get(PurePosixPath(check_key(key)).suffix, OTHER)
        whole = isinstance(content, bytes)
        try:
            with named_failures(key):
                obstore.put(
                    self._store,
                    key,
                    content,
                    attributes={"Content-Type": kind, "Content-Disposition": "attachment"},
                    use_multipart=not whole,
                    chunk_size=PIECE,
                    max_concurrency=AT_ONCE,
                )
        except FileMissing as error:  # of an upload whose parts are gone
            raise StorageUnreachable("the storage of the files forgot what was sent") from error

    def _check_whole(self, key: str, size: int) -> None:
        """Compare the size of what was joined from pieces; each piece was checked by its SHA-256."""
        kept = self.facts(key).size
        if kept != size:
            self.delete(key)
            raise StorageUnreachable(f"the storage of the files kept {kept} bytes of {size}")


class _Counted:
    """A stream, with the size and the SHA-256 of what was read from it."""

    def __init__(self, stream: Stream) -> None:
        self._stream = stream
        self.size, self.digest = 0, hashlib.sha256()

    def piece(self) -> bytes:
        """Return the next piece, whole but for the last; empty at the end."""
        parts: list[bytes] = []
        missing = PIECE
        while missing and (part := self._stream.read(missing)):
            parts.append(part)
            missing -= len(part)
        piece = b"".join(parts)
        self.size += len(piece)
        self.digest.update(piece)
        return piece
