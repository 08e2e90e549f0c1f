"""A library at a glance."""

from collections.abc import Iterator, Sequence

from faience_client.connection import Connection
from faience_client.models import Counts, Method, Queue, Tag


class Overview:
    """What there is, how much, and what goes on."""

    _service: Connection

    def methods(self) -> list[Method]:
        """Return the methods with their blocks and weights."""
        return [Method.model_validate(item) for item in self._service.ask("/v1/methods")["items"]]

    def tags(self, q: str | None = None) -> Iterator[Tag]:
        """Yield the tags, perhaps those with these letters."""
        return self._service.pages("/v1/tags", Tag.model_validate, q=q)

    def counts(self, *, q: str | None = None, tags: Sequence[str] = ()) -> Counts:
        """Return how many shapes there are, by status; see `Shapes.shapes`."""
        return Counts.model_validate(self._service.ask("/v1/counts", q=q, tag=list(tags)))

    def queue(self) -> Queue:
        """Return what waits and what runs."""
        return Queue.model_validate(self._service.ask("/v1/queue"))

    def ready(self) -> bool:
        """Return whether the service can be asked; waits for it as long as the client is patient."""
        return self._service.send("GET", "/readyz").is_success

    def metrics(self) -> str:
        """Return numbers in Prometheus' text format."""
        return self._service.send("GET", "/metrics").text
