"""Duplicates over HTTP: groups page by page, and pairs that somebody dismissed."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from index.keys import Keys
from index.scopes import Scope
from tests.problems import problem
from tests.serving import Serving, serving, settings_for, wait_until
from tests.test_duplicates import FAR, ONE, OTHER, exported_anew

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL

MESHES = {"a": ONE, "b": exported_anew(ONE, 1), "c": OTHER, "d": FAR, "e": exported_anew(FAR, 1)}


@pytest.fixture
def service(tmp_path: Path) -> Iterator[Serving]:
    with serving(settings_for(tmp_path)) as running:
        for name, ply in MESHES.items():
            assert running.add({f"{name}.ply": ply}).status_code == 201
        yield running


def ids(service: Serving) -> dict[str, str]:
    return {shape["name"]: shape["id"] for shape in service.client.get("/v1/shapes").json()["items"]}


def groups(service: Serving, **params: Any) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = []
    while True:
        page = service.client.get("/v1/duplicates", params=params).json()
        found += page["items"]
        if page["next_cursor"] is None:
            return found
        params["cursor"] = page["next_cursor"]


def names(found: list[dict[str, Any]]) -> set[str]:
    return {"".join(sorted(shape["name"] for shape in group["shapes"])) for group in found}


def dismissal(service: Serving, one: str, other: str) -> str:
    known = ids(service)
    return f"/v1/duplicates/dismissals/{known[one]}/{known[other]}"


def test_groups_come_page_by_page_with_their_evidence(service: Serving) -> None:
    found = groups(service, limit=1)
    assert names(found) == {"abc", "de"}
    known = ids(service)
    group = next(group for group in found if len(group["shapes"]) == 3)
    assert group["relation"] == "recoloured"
    told = {frozenset((pair["one"], pair["other"])): pair["relation"] for pair in group["evidence"]}
    assert told[frozenset((known["a"], known["b"]))]["name"] == "same_shape"
    assert told[frozenset((known["a"], known["c"]))]["name"] == "recoloured"
    assert told[frozenset((known["a"], known["c"]))]["colour_distance"] > 0
    assert {group["id"] for group in found} == {group["id"] for group in groups(service)}


def test_only_the_relations_that_are_asked_for_join(service: Serving) -> None:
    assert names(groups(service, relation="same_shape")) == {"ab", "de"}
    assert names(groups(service, relation=["same_file", "re_posed"])) == set()
    problem(service.client.get("/v1/duplicates?relation=similar"), 422, "invalid_request")
    problem(service.client.get("/v1/duplicates?limit=0"), 422, "invalid_request")
    problem(service.client.get("/v1/duplicates?cursor=x"), 422, "bad_cursor")


def test_dismissed_pairs_stay_away_until_that_is_taken_back(service: Serving) -> None:
    first = service.client.put(dismissal(service, "d", "e"))
    assert first.status_code == 200
    assert service.client.put(dismissal(service, "e", "d")).json() == first.json()
    assert names(groups(service)) == {"abc"}
    listed = service.client.get("/v1/duplicates/dismissals").json()
    assert listed == {"items": [first.json()], "next_cursor": None}
    assert service.client.delete(dismissal(service, "e", "d")).status_code == 204
    problem(service.client.delete(dismissal(service, "e", "d")), 404, "not_dismissed")
    assert names(groups(service)) == {"abc", "de"}


def test_dismissals_are_there_after_a_restart(tmp_path: Path) -> None:
    with serving(settings_for(tmp_path)) as running:
        for name in "de":
            assert running.add({f"{name}.ply": MESHES[name]}).status_code == 201
        assert running.client.put(dismissal(running, "d", "e")).status_code == 200
    with serving(settings_for(tmp_path)) as running:
        assert groups(running) == []
        assert len(running.client.get("/v1/duplicates/dismissals").json()["items"]) == 1


def test_a_pair_needs_two_shapes_that_are_there(service: Serving) -> None:
    problem(service.client.put(dismissal(service, "a", "a")), 422, "not_a_pair")
    one = ids(service)["a"]
    problem(service.client.put(f"/v1/duplicates/dismissals/{one}/nobody"), 404, "not_found")
    problem(service.client.get("/v1/duplicates/dismissals?cursor=x"), 422, "bad_cursor")


def test_a_read_key_may_look_but_not_dismiss(service: Serving) -> None:
    path, keys = dismissal(service, "d", "e"), Keys(service.library.engine)
    reading = {"Authorization": f"Bearer {keys.create('reader', Scope.READ)[1]}"}
    writing = {"Authorization": f"Bearer {keys.create('writer', Scope.WRITE)[1]}"}
    wait_for_keys(service)
    for method in ("PUT", "DELETE"):
        problem(service.client.request(method, path, headers=reading), 403, "read_only_key")
    assert service.client.put(path, headers=writing).status_code == 200
    for looked_at in ("/v1/duplicates", "/v1/duplicates/dismissals"):
        assert service.client.get(looked_at, headers=reading).status_code == 200
        problem(service.client.get(looked_at), 401, "unauthorised")


def wait_for_keys(service: Serving) -> None:
    wait_until(lambda: service.client.get("/v1/methods").status_code == 401)
