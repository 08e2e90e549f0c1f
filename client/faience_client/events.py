"""Shapes as they change, from the service's stream of server-sent events."""

import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from faience_client.models import Shape


@dataclass(frozen=True)
class Changed:
    """A shape was added, or is not what it was."""

    shape: Shape


@dataclass(frozen=True)
class Removed:
    """A shape is gone."""

    id: str


Event = Changed | Removed


@dataclass(frozen=True)
class Told:
    """An event, and after which revision the stream goes on once it is known."""

    event: Event | None  # None at the start, where only the revision is told
    revision: str | None  # None in the middle of a batch


def read_events(lines: Iterable[str]) -> Iterator[Told]:
    """Yield the events of a stream; see "Server-sent events" in the HTML standard.

    Parameters
    ----------
    lines : iterable of str
        Without their ends.
    """
    fields: dict[str, str] = {}
    for line in lines:
        if line:
            name, _, value = line.partition(":")
            fields[name] = value.removeprefix(" ")
            continue
        yield Told(_event(fields), fields.get("id"))
        fields = {}


def _event(fields: dict[str, str]) -> Event | None:
    """Return what an event says; None for a ping, or what a later service tells of."""
    if fields.get("event") == "shape":
        return Changed(Shape.model_validate_json(fields["data"]))
    if fields.get("event") == "removed":
        return Removed(json.loads(fields["data"])["id"])
    return None
