"""A client of a bucket, made from an address and the environment; its failures by names of ours."""

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import timedelta

from obstore.exceptions import BaseError
from obstore.store import S3Store

from index.errors import FileMissing, StorageUnreachable, UnknownStorage

RETRIES = 4  # of one request, within half a minute; then the caller is told
_ADDRESS = re.compile(r"s3://[a-z0-9][a-z0-9.-]{1,61}[a-z0-9](/[A-Za-z0-9._-]+)*/?")
_ENDPOINTS = ("AWS_ENDPOINT_URL_S3", "AWS_ENDPOINT_URL", "AWS_ENDPOINT")
_NO_BUCKET = "NoSuchBucket"  # as S3 calls it; of a file that is absent it says NoSuchKey
# A client is a runtime of threads; one for each of many processors would fill a job's address space.
os.environ.setdefault("TOKIO_WORKER_THREADS", "2")


class BucketMissing(StorageUnreachable):
    """There is no such bucket: at the start the address is wrong, later it was removed."""


def given_endpoint() -> str | None:
    """Return the address of the server that the environment names, if it does."""
    return next((os.environ[name] for name in _ENDPOINTS if os.environ.get(name)), None)


def object_client(url: str, endpoint: str | None) -> S3Store:
    """Return a client for ``s3://BUCKET/PREFIX``; it asks nobody yet.

    Credentials and region come from the environment, as AWS names them. An endpoint without encryption is
    taken where it says so itself (``http://``).

    Raises
    ------
    UnknownStorage
        The address or the environment is not as it must be.
    """
    if not _ADDRESS.fullmatch(url):
        raise UnknownStorage("the address of a bucket is s3://BUCKET or s3://BUCKET/PREFIX, without keys")
    given = {"checksum_algorithm": os.environ.get("AWS_CHECKSUM_ALGORITHM", "SHA256")}
    if endpoint is not None:
        given["endpoint"] = endpoint
    try:
        return S3Store.from_url(
            url.rstrip("/"),
            client_options={"allow_http": str(endpoint).startswith("http://"), "timeout": "60s"},
            retry_config={"max_retries": RETRIES, "retry_timeout": timedelta(seconds=30)},
            **given,  # type: ignore[arg-type]  # its options have types that exist for checkers alone
        )
    except (BaseError, ValueError) as error:
        raise UnknownStorage(f"no client can be made for {url}; are the AWS_… variables right?") from error


@contextmanager
def named_failures(what: str) -> Iterator[None]:
    """Give the failures of a request their own names.

    Raises
    ------
    FileMissing
    BucketMissing, StorageUnreachable
        What the server or the network said is in the cause, for the log.
    """
    try:
        yield
    except FileNotFoundError as error:
        if _NO_BUCKET in str(error):
            raise BucketMissing("the bucket of the files is not there") from error
        raise FileMissing(f"no file is kept under {what!r}") from None
    except BaseError as error:
        if _NO_BUCKET in str(error):
            raise BucketMissing("the bucket of the files is not there") from error
        raise StorageUnreachable("the storage of the files does not answer, or refuses") from error
