"""What looks like this, and why not more."""

from collections.abc import Mapping
from typing import Any

from faience_client.connection import Connection
from faience_client.models import Answer, RememberedQuery, Why
from faience_client.sending import Source, Upload

Weights = Mapping[str, float]  # block → weight: the dial between geometry and colour

DESCRIBING = 600.0  # seconds that one mesh may take


class Answers:
    """Ranked answers."""

    _service: Connection

    def similar(
        self,
        shape_id: str,
        *,
        method: str | None = None,
        limit: int | None = None,
        weights: Weights | None = None,
        relations: bool = False,
    ) -> Answer:
        """Rank the other shapes by their distance to one of the library.

        Parameters
        ----------
        method : str, optional
            As `Overview.methods` lists them; the service's default otherwise.
        weights : mapping of str to float, optional
            Own weights of the method's blocks.
        relations : bool
            Whether to say what each result is to the query.

        Raises
        ------
        Refused, NotReached
        """
        parameters = _question(method, limit, weights, relations)
        return Answer.model_validate(self._service.ask(f"/v1/shapes/{shape_id}/similar", **parameters))

    def search(
        self,
        *files: Source,
        allow_untextured: bool = False,
        remember: bool = False,
        method: str | None = None,
        limit: int | None = None,
        weights: Weights | None = None,
        relations: bool = False,
    ) -> Answer:
        """Rank the library by distance to a mesh that is not kept; see `similar` and `Shapes.add`.

        With ``remember`` its id can be asked again for an hour: `similar_to_query`, `why_query`.
        """
        parameters = {**_question(method, limit, weights, relations), "remember": remember or None}
        fields = {"allow_untextured": "true"} if allow_untextured else {}
        with Upload(files, fields).bodies() as body:
            reply = self._service.send("POST", "/v1/search", parameters, body=body, waits=DESCRIBING)
        return Answer.model_validate(reply.json())

    def query(self, query_id: str) -> RememberedQuery:
        """Return a query that is remembered."""
        return RememberedQuery.model_validate(self._service.ask(f"/v1/queries/{query_id}"))

    def similar_to_query(
        self,
        query_id: str,
        *,
        method: str | None = None,
        limit: int | None = None,
        weights: Weights | None = None,
        relations: bool = False,
    ) -> Answer:
        """Rank the library anew by a query that is remembered; see `similar`."""
        parameters = _question(method, limit, weights, relations)
        return Answer.model_validate(self._service.ask(f"/v1/queries/{query_id}/similar", **parameters))

    def query_thumbnail(self, query_id: str, width: int | None = None) -> bytes:
        """Return a query's picture as PNG."""
        return self._service.send("GET", f"/v1/queries/{query_id}/thumbnail.png", {"width": width}).content

    def query_preview(self, query_id: str) -> bytes:
        """Return a query's small mesh as GLB."""
        return self._service.send("GET", f"/v1/queries/{query_id}/preview.glb").content

    def why(
        self, shape_id: str, other: str, *, method: str | None = None, weights: Weights | None = None
    ) -> Why:
        """Return what the distance of two shapes is made of."""
        return Why.model_validate(self._service.ask(_why("shapes", shape_id, other), **_by(method, weights)))

    def why_surfaces(
        self, shape_id: str, other: str, *, method: str | None = None, weights: Weights | None = None
    ) -> tuple[bytes, bytes]:
        """Return both meshes as GLB, coloured by how much each place adds to their distance."""
        return self._surfaces(_why("shapes", shape_id, other), _by(method, weights))

    def why_query(
        self, query_id: str, other: str, *, method: str | None = None, weights: Weights | None = None
    ) -> Why:
        """Return what the distance of a remembered query and a shape is made of."""
        return Why.model_validate(self._service.ask(_why("queries", query_id, other), **_by(method, weights)))

    def why_query_surfaces(
        self, query_id: str, other: str, *, method: str | None = None, weights: Weights | None = None
    ) -> tuple[bytes, bytes]:
        """Return a remembered query's mesh and a shape's; see `why_surfaces`."""
        return self._surfaces(_why("queries", query_id, other), _by(method, weights))

    def _surfaces(self, path: str, parameters: dict[str, Any]) -> tuple[bytes, bytes]:
        query, result = (
            self._service.send("GET", f"{path}/{side}.glb", parameters).content
            for side in ("query", "result")
        )
        return query, result


def _question(
    method: str | None, limit: int | None, weights: Weights | None, relations: bool
) -> dict[str, Any]:
    return {**_by(method, weights), "limit": limit, "relations": relations or None}


def _by(method: str | None, weights: Weights | None) -> dict[str, Any]:
    return {"method": method, "weights": weights}


def _why(kind: str, one: str, other: str) -> str:
    return f"/v1/{kind}/{one}/why/{other}"
