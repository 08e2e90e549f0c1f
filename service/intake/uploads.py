"""A request's body becomes a `Submission` in a temporary folder, or a refusal that leaves nothing behind."""

import contextlib
from collections.abc import AsyncIterator
from pathlib import Path

import anyio
from anyio import to_thread
from starlette.requests import ClientDisconnect, Request

from service.intake.fields import BadField, check_name, read_flag, read_metadata
from service.intake.multipart import FormLimits, FormReceiver, IncompleteBody, UploadRefused
from service.intake.submissions import Submission
from service.library import Library
from service.settings import Settings

FIELDS = frozenset({"name", "metadata", "allow_untextured"})


class BodyTooLarge(UploadRefused):
    """The body is longer than one upload may be."""

    code = "body_too_large"


class NoFiles(UploadRefused):
    """The form holds no file."""

    code = "no_files"


@contextlib.asynccontextmanager
async def receiving(request: Request, library: Library) -> AsyncIterator[Submission]:
    """Receive a whole upload; its temporary files are gone when the block ends.

    Raises
    ------
    UploadRefused, BadField, MeshError, StorageFull
        What is wrong with it.
    """
    settings = library.settings
    announced = request.headers.get("content-length", "0")
    if announced.isdecimal():
        _check_size(int(announced), settings)
        await to_thread.run_sync(library.check_space, int(announced))
    scratch = library.incoming.scratch()
    folder = await to_thread.run_sync(scratch.__enter__)
    try:
        yield _submission(await _receive(request, folder, settings))
    finally:
        with anyio.CancelScope(shield=True):
            await to_thread.run_sync(scratch.__exit__, None, None, None)


async def _receive(request: Request, folder: Path, settings: Settings) -> FormReceiver:
    limits = FormLimits(files=settings.max_files, field_bytes=settings.max_field_bytes)
    receiver = FormReceiver(request.headers.get("content-type", ""), folder, limits)
    try:
        size = 0
        async for chunk in request.stream():
            size += len(chunk)
            _check_size(size, settings)
            await to_thread.run_sync(receiver.write, chunk)
        receiver.finish()
    except ClientDisconnect as error:
        raise IncompleteBody("the connection closed before the body was complete") from error
    finally:
        receiver.close()
    return receiver


def _check_size(size: int, settings: Settings) -> None:
    if size > settings.max_body_bytes:
        raise BodyTooLarge(f"an upload has at most {settings.max_body_bytes} bytes")


def _submission(received: FormReceiver) -> Submission:
    if not received.files:
        raise NoFiles("the form holds no file; send at least one in the field 'files'")
    unknown = set(received.fields) - FIELDS
    if unknown:
        raise BadField(f"unknown field {min(unknown)!r}; known are files, {', '.join(sorted(FIELDS))}")
    name = received.fields.get("name", "").strip()
    return Submission(
        files=tuple(received.files),
        name=check_name(name) if name else None,
        metadata=read_metadata(received.fields.get("metadata") or "{}"),
        allow_untextured=read_flag("allow_untextured", received.fields.get("allow_untextured", "")),
    )
