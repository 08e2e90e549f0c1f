"""Ranked answers over HTTP."""

import json
from collections.abc import Iterator

import pytest

from tests.fakes import coloured_triangle
from tests.problems import problem
from tests.serving import Serving, serving, settings_for

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL

LEVELS = (10, 60, 130, 250)  # of red; the fake description orders shapes by it


@pytest.fixture(scope="module")
def service(database: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    with serving(settings_for(tmp_path_factory.mktemp("library"))) as running:
        for level in LEVELS:
            assert running.add({f"red{level}.ply": coloured_triangle(level)}).status_code == 201
        yield running


def shape_id(service: Serving, level: int) -> str:
    found: str = service.client.get("/v1/shapes", params={"q": f"red{level}"}).json()["items"][0]["id"]
    return found


def names(answer: dict[str, list[dict[str, dict[str, str]]]]) -> list[str]:
    return [hit["shape"]["name"] for hit in answer["results"]]


def test_similar_shapes_are_ranked_without_the_shape_itself(service: Serving) -> None:
    answer = service.client.get(f"/v1/shapes/{shape_id(service, 60)}/similar").json()
    assert answer["method"] == "fused"
    assert answer["took_ms"] > 0
    assert names(answer) == ["red10", "red130", "red250"]
    assert [hit["rank"] for hit in answer["results"]] == [1, 2, 3]
    distances = [hit["distance"] for hit in answer["results"]]
    assert distances == sorted(distances)
    assert "query" not in answer or answer["query"] is None


def test_an_answer_says_whether_it_is_exact(service: Serving, monkeypatch: pytest.MonkeyPatch) -> None:
    path = f"/v1/shapes/{shape_id(service, 60)}/similar"
    assert service.client.get(path).json()["exact"] is True
    asked: list[object] = []

    def proves(_: object, *question: object) -> bool:
        asked.append(question)
        return False

    monkeypatch.setattr("index.searcher.Searcher.proves", proves)
    assert service.client.get(path, params={"limit": 2}).json()["exact"] is False
    assert asked == [("fused", 24, None)]


def test_method_and_limit_are_obeyed(service: Serving) -> None:
    path = f"/v1/shapes/{shape_id(service, 10)}/similar"
    for method in ("hks", "chks", "diffusion", "colour-diffusion", "colour-histogram"):
        answer = service.client.get(path, params={"method": method, "limit": 2}).json()
        assert answer["method"] == method
        assert len(answer["results"]) == 2


def test_results_of_the_refined_method_tell_their_relation_where_that_is_asked_for(
    service: Serving,
) -> None:
    plain = f"/v1/shapes/{shape_id(service, 60)}/similar"
    path = f"{plain}?relations=true"
    assert [hit["relation"] for hit in service.client.get(plain).json()["results"]] == [None] * 3
    told = [hit["relation"] for hit in service.client.get(path).json()["results"]]
    assert [relation["name"] for relation in told] == ["similar"] * 3
    for relation in told:
        assert relation["shape_distance"] > 0
        assert relation["colour_distance"] > 0
    for other in ("method=hks", "weights=log-hks:1"):
        results = service.client.get(f"{path}&{other}").json()["results"]
        assert [hit["relation"] for hit in results] == [None] * 3


def test_a_mesh_that_is_kept_already_is_found_as_the_same_file(service: Serving) -> None:
    for files, name in (
        ({"other name.ply": coloured_triangle(130)}, "same_file"),
        ({"a.ply": coloured_triangle(130).replace(b"ply\n", b"ply\ncomment again\n", 1)}, "same_shape"),
    ):
        parts = [("files", each) for each in files.items()]
        first = service.client.post("/v1/search?relations=true", files=parts).json()["results"][0]
        assert (first["shape"]["name"], first["relation"]["name"]) == ("red130", name)
        assert first["relation"]["misfit"] == pytest.approx(0.0, abs=1e-6)


def test_own_weights_are_taken_in_both_forms_and_scale_the_distance(service: Serving) -> None:
    path = f"/v1/shapes/{shape_id(service, 10)}/similar"
    plain = {"log-hks": 0.0, "colour-histogram": 2.0, "colour-curves": 0.0}
    as_json = service.client.get(path, params={"weights": json.dumps(plain)}).json()["results"]
    as_list = ",".join(f"{block}:{weight}" for block, weight in plain.items())
    assert service.client.get(path, params={"weights": as_list}).json()["results"] == as_json
    single = service.client.get(path, params={"method": "colour-histogram"}).json()["results"]
    assert [hit["distance"] for hit in as_json] == pytest.approx([2 * hit["distance"] for hit in single])


@pytest.mark.parametrize(
    ("query", "code"),
    [
        ("method=nothing", "unknown_method"),
        ("weights=hks-0:1", "bad_weights"),
        ("weights=log-hks:-1", "bad_weights"),
        ("weights=log-hks:nan", "bad_weights"),
        ("weights=log-hks", "bad_weights"),
        ("weights=log-hks:0,colour-histogram:0,colour-curves:0", "bad_weights"),
        ("limit=0", "invalid_request"),
        ("limit=1001", "invalid_request"),
    ],
)
def test_bad_questions_are_refused_by_both_calls(service: Serving, query: str, code: str) -> None:
    problem(service.client.get(f"/v1/shapes/{shape_id(service, 10)}/similar?{query}"), 422, code)
    files = [("files", ("a.ply", coloured_triangle()))]
    problem(service.client.post(f"/v1/search?{query}", files=files), 422, code)


def test_a_shape_that_is_not_ready_cannot_be_compared(service: Serving) -> None:
    broken = coloured_triangle().replace(b"3 0 1 3", b"3 0 1 9")
    path = service.add({"broken.ply": broken}).headers["location"]
    problem(service.client.get(f"{path}/similar"), 409, "not_ready")


def test_a_mesh_that_is_not_kept_is_answered_and_leaves_nothing(service: Serving) -> None:
    root = service.library.settings.data_dir
    before = {path for path in root.rglob("*") if "index" not in path.parts}
    files = [("files", ("query.ply", coloured_triangle(128)))]
    answer = service.client.post("/v1/search", files=files, params={"limit": 2}).json()
    assert names(answer) == ["red130", "red60"]
    assert answer["query"]["mesh"]["colour"] == "vertex"
    assert {path for path in root.rglob("*") if "index" not in path.parts} == before


def test_the_stored_twin_of_a_query_is_at_distance_zero(service: Serving) -> None:
    files = [("files", ("anything.ply", coloured_triangle(130)))]
    best = service.client.post("/v1/search", files=files).json()["results"][0]
    assert (best["shape"]["name"], best["distance"]) == ("red130", 0)


@pytest.mark.parametrize(
    ("name", "content", "code"),
    [
        ("crash.ply", coloured_triangle(), "gave_up"),
        ("defect.ply", coloured_triangle(), "unexpected"),
        ("eat.ply", coloured_triangle(), "too_complex"),
        ("cut.ply", coloured_triangle()[:-20], "truncated"),
        ("a.txt", b"", "no_mesh"),
    ],
)
def test_a_query_that_cannot_be_described_is_refused_with_its_code(
    service: Serving, name: str, content: bytes, code: str
) -> None:
    problem(service.client.post("/v1/search", files=[("files", (name, content))]), 422, code)
    assert service.client.get("/readyz").status_code == 200


def test_more_searches_than_may_wait_are_told_to_come_back(service: Serving) -> None:
    turnstile = service.turnstile
    places = service.library.settings.search_slots + service.library.settings.search_queue
    held = [turnstile.enter() for _ in range(places)]
    for place in held:
        place.__enter__()
    try:
        answer = service.client.post("/v1/search", files=[("files", ("a.ply", coloured_triangle()))])
        problem(answer, 503, "too_busy")
        assert answer.headers["retry-after"]
    finally:
        for place in held:
            place.__exit__(None, None, None)
