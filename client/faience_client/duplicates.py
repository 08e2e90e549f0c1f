"""The groups of a library, and what is none."""

from collections.abc import Iterator, Sequence

from faience_client.connection import Connection
from faience_client.errors import Refused
from faience_client.models import Dismissal, Group, Relation
from faience_client.shapes import NOT_FOUND


class Duplicates:
    """Shapes that are the same."""

    _service: Connection

    def duplicates(self, relations: Sequence[Relation] = ()) -> Iterator[Group]:
        """Yield groups of duplicates, joined by these relations; by all but ``re_posed`` without any."""
        return self._service.pages("/v1/duplicates", Group.model_validate, relation=list(relations) or None)

    def dismissals(self) -> Iterator[Dismissal]:
        """Yield the pairs that somebody called no duplicates."""
        return self._service.pages("/v1/duplicates/dismissals", Dismissal.model_validate)

    def dismiss(self, one: str, other: str) -> Dismissal:
        """Say that two shapes are no duplicates."""
        reply = self._service.send("PUT", f"/v1/duplicates/dismissals/{one}/{other}")
        return Dismissal.model_validate(reply.json())

    def undismiss(self, one: str, other: str) -> None:
        """Take it back."""
        try:
            self._service.send("DELETE", f"/v1/duplicates/dismissals/{one}/{other}")
        except Refused as refused:
            if refused.status != NOT_FOUND or not refused.repeated:
                raise
