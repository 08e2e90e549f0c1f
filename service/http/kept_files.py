"""A kept file as an answer: from the disk, from a bucket piece by piece, or by an address in the bucket."""

import contextlib
import os
import stat
from collections.abc import AsyncIterator, Mapping

from anyio import to_thread
from starlette.responses import FileResponse, RedirectResponse, Response
from starlette.types import Receive, Scope, Send

from index.errors import FileMissing
from index.files import FileFacts, FileStore
from service.http.head import ONLY_START
from service.library import Library

GOOD_FOR = 300.0  # seconds that a signed address can be followed
PIECE = 4 << 20  # bytes of a file in a bucket that stand in memory at once
UNKEPT = {"Cache-Control": "no-store"}


def file_response(
    library: Library, key: str, media_type: str, headers: Mapping[str, str], name: str | None = None
) -> Response:
    """Return the answer that brings a file, whole or the range of it that is asked for.

    Parameters
    ----------
    name : str, optional
        Under which a browser should save it.

    Raises
    ------
    FileMissing, StorageUnreachable
    """
    files = library.files
    if files.folder is not None:
        path = files.folder / key
        if not path.is_file():
            raise FileMissing(f"no file is kept under {key!r}")
        return FileResponse(path, media_type=media_type, filename=name, headers=headers)
    facts = files.facts(key)
    address = files.address(key, GOOD_FOR) if library.settings.presigned else None
    if address is not None:
        return RedirectResponse(address, headers=UNKEPT)  # 307
    return _ObjectResponse(files, key, facts, media_type=media_type, filename=name, headers=headers)


class _ObjectResponse(FileResponse):
    """Answers as for a file on a disk, ranges too; each piece is a request of its own, which can be repeated.

    What is replaced meanwhile under the same key is never longer than one piece.
    """

    chunk_size = PIECE

    def __init__(
        self,
        files: FileStore,
        key: str,
        facts: FileFacts,
        *,
        media_type: str,
        filename: str | None,
        headers: Mapping[str, str],
    ) -> None:
        super().__init__(
            key,
            media_type=media_type,
            filename=filename,
            headers=headers,
            stat_result=_as_on_disk(facts),
        )
        self._files, self._key, self._size = files, key, facts.size

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer; nothing is fetched for a body that nobody is sent."""
        await super().__call__({**scope, "method": "HEAD"} if scope.get(ONLY_START) else scope, receive, send)

    @contextlib.asynccontextmanager
    async def _open_file(self) -> AsyncIterator["_ObjectReader"]:  # type: ignore[override]  # its one way in
        yield _ObjectReader(self._files, self._key, self._size)


class _ObjectReader:
    """The part of an asynchronous file that answers use."""

    def __init__(self, files: FileStore, key: str, size: int) -> None:
        self._files, self._key, self._size = files, key, size
        self._place = 0

    async def seek(self, place: int) -> int:
        """Go on reading there."""
        self._place = place
        return place

    async def read(self, size: int) -> bytes:
        """Return the next bytes; none at the end."""
        start, stop = self._place, min(self._place + size, self._size)
        self._place = stop
        if start >= stop:
            return b""
        return await to_thread.run_sync(self._files.get_part, self._key, start, stop)


def _as_on_disk(facts: FileFacts) -> os.stat_result:
    moment = int(facts.changed)
    return os.stat_result((stat.S_IFREG, 0, 0, 1, 0, 0, facts.size, moment, moment, moment))
