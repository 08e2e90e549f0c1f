"""Where files are kept, by address: in a folder by default, or in a bucket."""

from pathlib import Path
from urllib.parse import unquote, urlsplit

from index.errors import UnknownStorage
from index.files import FileStore
from index.local_files import LocalFiles


def open_files(url: str | None, folder: Path) -> FileStore:
    """Return the store of an address, looked into where it is elsewhere.

    Parameters
    ----------
    url : str, optional
        ``s3://BUCKET/PREFIX`` or ``file:///FOLDER``.
    folder : Path
        Where files are kept without one.

    Raises
    ------
    UnknownStorage
        Another kind of address, or a bucket that is not there.
    StorageUnreachable
    """
    if url is None:
        return LocalFiles(folder.resolve())
    parts = urlsplit(url)
    if parts.scheme == "s3":
        return _open_bucket(url)
    if parts.scheme == "file" and parts.netloc in ("", "localhost") and len(parts.path) > 1:
        return LocalFiles(Path(unquote(parts.path)).resolve())
    raise UnknownStorage(
        f"files are kept in file:///FOLDER or s3://BUCKET/PREFIX, not in {parts.scheme!r:.40}"
    )


def _open_bucket(url: str) -> FileStore:
    from index.object_client import BucketMissing  # most libraries need no client of object storage
    from index.object_files import ObjectFiles

    bucket = ObjectFiles(url)
    try:
        bucket.check()
    except BucketMissing:
        raise UnknownStorage(f"there is no bucket for {url}; make it first") from None
    return bucket
