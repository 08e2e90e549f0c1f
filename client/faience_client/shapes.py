"""Shapes: add, list, look at, change, remove, watch."""

import json
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any
from urllib.parse import quote

import httpx2

from faience_client.connection import FIRST_WAIT, LONGEST_WAIT, Connection
from faience_client.errors import NotReached, Refused
from faience_client.events import Event, read_events
from faience_client.models import Descriptors, Shape, Status
from faience_client.sending import Source, Upload

PAGE = 200  # shapes fetched at once
NOT_FOUND, CONFLICT = 404, 409


class Shapes:
    """What a library keeps."""

    _service: Connection

    def add(
        self,
        *files: Source,
        name: str | None = None,
        metadata: Mapping[str, Any] | None = None,
        allow_untextured: bool = False,
        wait: float = 0,
    ) -> Shape:
        """Add a shape; what is known by its content is not added again.

        Parameters
        ----------
        *files : str, Path or (str, bytes)
            A PLY, an OBJ with its MTL and images, or a zip; by path, or as a name and bytes.
        name : str, optional
            The file's own without its ending otherwise.
        metadata : mapping, optional
            Anything that JSON can hold; ``{"tags": […]}`` are its tags.
        allow_untextured : bool
            Whether named images may be missing.
        wait : float
            Seconds to wait for it to be ready.

        Raises
        ------
        Refused, NotReached
        """
        fields = {"allow_untextured": "true"} if allow_untextured else {}
        if name is not None:
            fields["name"] = name
        if metadata is not None:
            fields["metadata"] = json.dumps(dict(metadata))
        with Upload(files, fields).bodies() as body:
            reply = self._service.send("POST", "/v1/shapes", {"wait": wait}, body=body, waits=wait)
        return Shape.model_validate(reply.json())

    def shape(self, shape_id: str) -> Shape:
        """Return a shape."""
        return Shape.model_validate(self._service.ask(_path(shape_id)))

    def shapes(
        self, *, q: str | None = None, status: Status | None = None, tags: Sequence[str] = ()
    ) -> Iterator[Shape]:
        """Yield shapes, newest first; all of them, or those with these words, tags or this status."""
        parameters = {"q": q, "status": status, "tag": list(tags), "limit": PAGE}
        return self._service.pages("/v1/shapes", Shape.model_validate, **parameters)

    def settled(self, shape_id: str, seconds: float = 600) -> Shape:
        """Return a shape once it is ready or failed.

        Raises
        ------
        TimeoutError
            It is neither after so many seconds.
        """
        deadline, pause = time.monotonic() + seconds, FIRST_WAIT
        while (shape := self.shape(shape_id)).status not in (Status.READY, Status.FAILED):
            if time.monotonic() > deadline:
                raise TimeoutError(f"the shape {shape_id} is still {shape.status} after {seconds:g} s")
            time.sleep(pause)
            pause = min(1.5 * pause, LONGEST_WAIT)
        return shape

    def change(
        self, shape_id: str, *, name: str | None = None, metadata: Mapping[str, Any] | None = None
    ) -> Shape:
        """Rename a shape, or replace its metadata; what is not given stays."""
        change = {"name": name, "metadata": None if metadata is None else dict(metadata)}
        given = {field: value for field, value in change.items() if value is not None}
        reply = self._service.send("PATCH", _path(shape_id), body=lambda: {"json": given})
        return Shape.model_validate(reply.json())

    def retry(self, shape_id: str) -> Shape:
        """Have a shape that failed described once more."""
        try:
            reply = self._service.send("POST", f"{_path(shape_id)}/retry")
        except Refused as refused:
            if refused.status != CONFLICT or not refused.repeated:
                raise
            return self.shape(shape_id)  # an earlier try arrived, its answer did not
        return Shape.model_validate(reply.json())

    def remove(self, shape_id: str) -> None:
        """Remove a shape and its files."""
        try:
            self._service.send("DELETE", _path(shape_id))
        except Refused as refused:
            if refused.status != NOT_FOUND or not refused.repeated:
                raise

    def download(self, shape_id: str, name: str, target: str | Path) -> Path:
        """Write one of a shape's files, as it was uploaded, to a path; return the path."""
        target = Path(target)
        with (
            self._service.stream(f"{_path(shape_id)}/files/{quote(name)}") as response,
            target.open("wb") as file,
        ):
            for piece in response.iter_bytes():
                file.write(piece)
        return target

    def thumbnail(self, shape_id: str, width: int | None = None) -> bytes:
        """Return a shape's picture as PNG, perhaps smaller (32 to 256 pixels wide)."""
        return self._service.send("GET", f"{_path(shape_id)}/thumbnail.png", {"width": width}).content

    def preview(self, shape_id: str) -> bytes:
        """Return a small mesh with the shape's colours as GLB."""
        return self._service.send("GET", f"{_path(shape_id)}/preview.glb").content

    def descriptors(self, shape_id: str) -> Descriptors:
        """Return a shape's numbers."""
        return Descriptors.model_validate(self._service.ask(f"{_path(shape_id)}/descriptors"))

    def watch(self, since: int | None = None) -> Iterator[Event]:
        """Yield shapes as they change, without end; a lost connection is made again, nothing is left out.

        Parameters
        ----------
        since : int, optional
            A revision to start after; from now on otherwise.
        """
        seen, quiet = None if since is None else str(since), FIRST_WAIT
        while True:
            headers = {} if seen is None else {"Last-Event-ID": seen}
            try:
                with self._service.stream("/v1/events", headers=headers) as response:
                    for told in read_events(response.iter_lines()):
                        seen, quiet = told.revision or seen, FIRST_WAIT
                        if told.event is not None:
                            yield told.event
            except httpx2.TransportError as error:
                if quiet > LONGEST_WAIT:
                    raise NotReached(f"the service tells nothing any more: {error}") from error
            time.sleep(quiet)
            quiet *= 2


def _path(shape_id: str) -> str:
    return f"/v1/shapes/{quote(shape_id, safe='')}"
