"""The service against its own description: schemathesis makes requests from it, good ones and bad ones."""

import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import httpx
import schemathesis
from hypothesis import strategies as st
from schemathesis.engine import events, from_schema
from schemathesis.engine.recorder import ScenarioRecorder
from schemathesis.transport.serialization import Binary

SEED = 2011
ENDLESS = "watchShapes"  # a stream of events ends when its listener goes; tests of its own listen to it
ANY_BUT_DEFECTS = ["2xx", "3xx", "4xx", "503", "507"]  # busy, and full: both are described, with what to do
# What a schema says of these is that they are text or bytes; what is in them decides.
OPAQUE = ["addShape", "searchByMesh", "listShapes", "findSimilar", "findSimilarToQuery", "changeShape"]
OPAQUE += ["listDuplicates", "listDismissals", "listTags"]  # cursors of their own
OPAQUE += ["dismissPair"]  # two ids that differ
OPAQUE += ["explainDistance", "explainOnQuery", "explainOnResult"]  # not all have places
OPAQUE += ["explainDistanceOfQuery", "explainQueryOnQuery", "explainQueryOnResult"]
# In a form everything is text: `true` in place of a name arrives as one, an empty list as nothing at all.
FORMS = ["addShape", "searchByMesh"]
LATER = ["getThumbnail", "getPreview"]  # are there when a new shape is ready
MESH = (
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 {height}\n3 0 1 2\n"
)


@dataclass(frozen=True, kw_only=True)
class Known:
    """What the library holds: without it few requests would come further than 404."""

    ids: Sequence[str]  # shapes to look at
    doomed: Sequence[str]  # shapes that may be removed
    names: Sequence[str]  # of their files
    cursor: str  # a page of the list


@dataclass(frozen=True, kw_only=True)
class ContractFigures:
    """What came of it."""

    seconds: float
    answers: Mapping[str, Mapping[int, int]]  # call → status → how many
    failures: Mapping[str, int]  # what contradicts the description → how often

    @property
    def requests(self) -> int:
        """How many requests were made."""
        return sum(sum(statuses.values()) for statuses in self.answers.values())


def known_of(client: httpx.Client) -> Known:
    """Ask a service what it holds; it needs a page of shapes and more."""
    page = client.get("/v1/shapes", params={"limit": 6}).json()
    ids = [shape["id"] for shape in page["items"]]
    names = sorted({file["name"] for shape in page["items"] for file in shape["files"]})
    return Known(ids=ids[2:], doomed=ids[:2], names=names, cursor=page["next_cursor"])


def check_contract(url: str, key: str, *, examples: int, seed: int = SEED) -> ContractFigures:
    """Send requests made from a service's description and hold its answers against it.

    Every answer has a described status, media type, headers and form, the code of an error among them; no
    defect is met; bad requests are refused and good ones are not; keys are demanded.

    Parameters
    ----------
    url : str
        Of a service with a page of ready shapes and more; it should not count the key's uploads
        (`FAIENCE_UPLOADS_PER_MINUTE=0`), or most end with 429. Its shapes are changed, and some removed.
    key : str
        A key that may write.
    examples : int
        Random requests of each call, beside those that the description's limits suggest.
    seed : int
        The same seed makes the same requests of the same library.
    """
    bearer = {"Authorization": f"Bearer {key}"}
    with httpx.Client(base_url=url, headers=bearer, timeout=60) as client:
        known = known_of(client)
        description = client.get("/openapi.json").json()
    config = schemathesis.Config.from_dict(_settings(url, bearer, known, examples, seed))
    schemathesis.openapi.format("binary", st.integers(0, 9).map(_mesh))
    schema = schemathesis.openapi.from_dict(_with_one_mesh(description), config=config)
    start = time.monotonic()
    recorders = list(_run(schema.exclude(operation_id=ENDLESS)))
    return ContractFigures(
        seconds=time.monotonic() - start, answers=_answers(recorders), failures=_failures(recorders)
    )


def _settings(url: str, headers: Mapping[str, str], known: Known, examples: int, seed: int) -> dict[str, Any]:
    return {
        "seed": seed,
        "base-url": url,
        "headers": headers,
        "continue-on-failure": True,
        "generation": {"max-examples": examples, "deterministic": True, "database": "none"},
        "checks": {"not_a_server_error": {"expected-statuses": ANY_BUT_DEFECTS}},
        "dictionaries": {
            "ids": {"values": list(known.ids)},
            "doomed": {"values": list(known.doomed)},
            "names": {"values": list(known.names)},
            "cursors": {"values": [known.cursor]},
            "weights": {"values": ["log-hks:2", '{"colour-histogram": 0.5}', "log-hks:0"]},
        },
        "parameters": {
            "path.shape_id": {"dictionary": "ids", "probability": 0.8},
            "path.one": {"dictionary": "ids", "probability": 0.8},
            "path.other": {"dictionary": "ids", "probability": 0.8},
            "path.name": {"dictionary": "names", "probability": 0.7},
            "query.cursor": {"dictionary": "cursors", "probability": 0.5},
            "query.weights": {"dictionary": "weights", "probability": 0.5},
        },
        "operations": [
            {
                "include-operation-id": "removeShape",
                "parameters": {"path.shape_id": {"dictionary": "doomed", "probability": 0.5}},
            },
            {
                "include-operation-id": OPAQUE,
                "checks": {"positive_data_acceptance": {"enabled": False}},
            },
            {
                "include-operation-id": FORMS,
                "checks": {"negative_data_rejection": {"enabled": False}},
            },
            {
                "include-operation-id": LATER,
                "checks": {"ensure_resource_availability": {"enabled": False}},
            },
        ],
    }


def _mesh(height: int) -> Binary:
    return Binary(MESH.format(height=height).encode())


def _with_one_mesh(description: dict[str, Any]) -> dict[str, Any]:
    """Add what a form's description cannot say to programs: one mesh, with a name that tells its kind."""
    for path in ("/v1/shapes", "/v1/search"):
        form = description["paths"][path]["post"]["requestBody"]["content"]["multipart/form-data"]
        header = {"schema": {"type": "string", "example": 'form-data; filename="sent.ply"'}}
        form["schema"]["properties"]["files"]["maxItems"] = 1
        form["encoding"] = {"files": {"headers": {"Content-Disposition": header}}}
    return description


def _run(schema: Any) -> Iterator[ScenarioRecorder]:
    for event in from_schema(schema).execute():
        if isinstance(event, events.ScenarioFinished):
            yield event.recorder
        if isinstance(event, events.FatalError):
            raise event.exception
        if isinstance(event, events.NonFatalError):
            raise RuntimeError(str(event.info))


def _answers(recorders: Sequence[ScenarioRecorder]) -> dict[str, dict[int, int]]:
    found: dict[str, Counter[int]] = {}
    for recorder in recorders:
        for interaction in recorder.interactions.values():
            if interaction.response is not None:
                found.setdefault(recorder.label, Counter())[interaction.response.status_code] += 1
    return {call: dict(sorted(statuses.items())) for call, statuses in sorted(found.items())}


def _failures(recorders: Sequence[ScenarioRecorder]) -> dict[str, int]:
    found: Counter[str] = Counter()
    for recorder in recorders:
        for checks in recorder.checks.values():
            for check in checks:
                if check.failure_info is not None:
                    failure = check.failure_info.failure
                    found[f"{recorder.label}: {check.name}: {failure.title}: {failure.message}"] += 1
    return dict(found)
