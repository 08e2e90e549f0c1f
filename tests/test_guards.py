"""Closed doors stay closed."""

import logging
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from pydantic import SecretStr

from index.keys import Keys
from index.scopes import Scope
from tests.fakes import coloured_triangle
from tests.problems import problem
from tests.serving import Serving, serving, settings_for, wait_until

KEYS = (SecretStr("first-key"), SecretStr("second-key"), SecretStr("schlüssel"))


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    settings = settings_for(tmp_path_factory.mktemp("library"), workers=0, api_keys=KEYS)
    with serving(settings) as running:
        yield running


CALLS = [
    ("GET", "/v1/shapes"),
    ("POST", "/v1/shapes"),
    ("GET", "/v1/shapes/x"),
    ("PATCH", "/v1/shapes/x"),
    ("DELETE", "/v1/shapes/x"),
    ("GET", "/v1/shapes/x/files/a"),
    ("GET", "/v1/shapes/x/thumbnail.png"),
    ("GET", "/v1/shapes/x/preview.glb"),
    ("GET", "/v1/shapes/x/descriptors"),
    ("GET", "/v1/shapes/x/similar"),
    ("GET", "/v1/shapes/x/why/y"),
    ("GET", "/v1/shapes/x/why/y/query.glb"),
    ("GET", "/v1/shapes/x/why/y/result.glb"),
    ("POST", "/v1/shapes/x/retry"),
    ("POST", "/v1/search"),
    ("GET", "/v1/methods"),
    ("GET", "/v1/duplicates"),
    ("GET", "/v1/duplicates/dismissals"),
    ("PUT", "/v1/duplicates/dismissals/x/y"),
    ("DELETE", "/v1/duplicates/dismissals/x/y"),
    ("GET", "/v1/tags"),
    ("GET", "/v1/counts"),
    ("GET", "/v1/queue"),
    ("GET", "/v1/queries/x"),
    ("GET", "/v1/queries/x/similar"),
    ("GET", "/v1/queries/x/thumbnail.png"),
    ("GET", "/v1/queries/x/preview.glb"),
    ("GET", "/v1/queries/x/why/y"),
    ("GET", "/v1/queries/x/why/y/query.glb"),
    ("GET", "/v1/queries/x/why/y/result.glb"),
    ("GET", "/v1/events"),
    ("GET", "/metrics"),
]
FOR_READERS = [call for call in CALLS if call[0] == "GET" or call == ("POST", "/v1/search")]


def bearing(secret: str) -> dict[str, str]:
    return {"authorization": f"Bearer {secret}"}


def new_key(service: Serving, scope: Scope) -> tuple[str, str]:
    """Make a key of the running service's library and wait until it opens; return its id and the key."""
    key, secret = Keys(service.library.engine).create("test", scope)
    wait_until(lambda: service.client.get("/v1/methods", headers=bearing(secret)).status_code == 200)
    return key.id, secret


def status_of(service: Serving, method: str, path: str, headers: dict[str, str]) -> int:
    """Return the status of an answer whose body may be endless."""
    body = {"name": "x"} if method == "PATCH" else None
    with service.client.stream(method, path, headers=headers, json=body) as answer:
        return answer.status_code


@pytest.mark.parametrize(("method", "path"), CALLS)
def test_nothing_of_the_library_is_told_without_a_key(service: Serving, method: str, path: str) -> None:
    body = {"name": "x"} if method == "PATCH" else None
    for header in ({}, bearing("wrong"), bearing("clé"), {"authorization": "Basic first-key"}):
        raw = [(name.encode(), value.encode()) for name, value in header.items()]
        answer = service.client.request(method, path, headers=raw, json=body)
        problem(answer, 401, "unauthorised")
        assert answer.headers["www-authenticate"] == "Bearer"


def _example_of(path: str) -> str:
    examples = {"{shape_id}": "x", "{query_id}": "x", "{name}": "a", "{one}": "x", "{other}": "y"}
    for part, example in examples.items():
        path = path.replace(part, example)
    return path


def test_every_call_of_the_interface_is_in_the_list_above_or_open(service: Serving) -> None:
    interface = service.client.get("/openapi.json").json()
    described = {
        (method.upper(), _example_of(path)): call
        for path, methods in interface["paths"].items()
        for method, call in methods.items()
    }
    assert set(described) == {*CALLS, ("GET", "/livez"), ("GET", "/readyz")}
    for name, call in described.items():
        guarded = name in CALLS
        assert ("security" in call) == guarded, name
        assert ({"401", "403"} <= set(call["responses"])) == guarded, name
        assert ("429" in call["responses"]) == (name in [("POST", "/v1/shapes"), ("POST", "/v1/search")])


@pytest.mark.parametrize("key", [key.get_secret_value() for key in KEYS])
def test_any_known_key_opens(service: Serving, key: str) -> None:
    header = [(b"authorization", f"Bearer {key}".encode())]
    assert service.client.get("/v1/shapes", headers=header).status_code == 200


@pytest.mark.parametrize("path", ["/livez", "/readyz", "/", "/docs", "/openapi.json", "/static/app.js"])
def test_what_holds_nothing_of_the_library_is_open(service: Serving, path: str) -> None:
    assert service.client.get(path).status_code == 200


def test_a_read_key_opens_what_changes_nothing_and_a_write_key_everything(service: Serving) -> None:
    _, reader = new_key(service, Scope.READ)
    _, writer = new_key(service, Scope.WRITE)
    for method, path in CALLS:
        assert status_of(service, method, path, bearing(writer)) not in (401, 403), (method, path)
        status = status_of(service, method, path, bearing(reader))
        if (method, path) in FOR_READERS:
            assert status not in (401, 403), (method, path)
        else:
            assert status == 403, (method, path)


def test_a_read_key_is_told_what_it_may_not_do(service: Serving) -> None:
    _, reader = new_key(service, Scope.READ)
    answer = service.client.delete("/v1/shapes/x", headers=bearing(reader))
    assert "--scope write" in problem(answer, 403, "read_only_key")
    assert answer.headers["www-authenticate"] == 'Bearer error="insufficient_scope"'


def test_a_revoked_key_opens_nothing_soon_after_and_its_stream_ends(service: Serving) -> None:
    key_id, secret = new_key(service, Scope.READ)
    with service.client.stream("GET", "/v1/events", headers=bearing(secret)) as events:
        assert events.status_code == 200
        Keys(service.library.engine).revoke(key_id)
        for _ in events.iter_lines():
            pass  # ends, or the client's patience does
    problem(service.client.get("/v1/methods", headers=bearing(secret)), 401, "unauthorised")


def test_the_first_key_of_an_open_service_closes_it_and_revoking_it_opens_nothing(tmp_path: Path) -> None:
    with serving(settings_for(tmp_path, workers=0)) as running:
        assert running.client.get("/v1/methods").status_code == 200
        keys = Keys(running.library.engine)
        key, secret = keys.create("first", Scope.READ)
        wait_until(lambda: running.client.get("/v1/methods").status_code == 401)
        assert running.client.get("/v1/methods", headers=bearing(secret)).status_code == 200
        keys.revoke(key.id)
        wait_until(lambda: running.client.get("/v1/methods", headers=bearing(secret)).status_code == 401)
        problem(running.client.get("/v1/methods"), 401, "unauthorised")
    with serving(settings_for(tmp_path, workers=0)) as again:  # for this machine alone: open as before
        assert again.client.get("/v1/methods").status_code == 200


def test_a_service_for_others_stays_closed_without_any_key(tmp_path: Path) -> None:
    settings = settings_for(tmp_path, workers=0, host="0.0.0.0")  # noqa: S104 - the test's server is on loopback
    with serving(settings) as running:
        for method, path in CALLS:
            assert status_of(running, method, path, {}) == 401, (method, path)


def test_uploads_are_counted_by_key_and_refused_before_their_body_is_read(tmp_path: Path) -> None:
    settings = settings_for(tmp_path, workers=0, api_keys=KEYS, uploads_per_minute=2, max_body_bytes=2**20)
    big = {"files": ("a.ply", bytes(4 * 2**20))}  # read, it would be refused as too large
    with serving(settings) as running:

        def send(key: str, path: str) -> httpx.Response:
            return running.client.post(path, headers=bearing(key), files=big)

        problem(send("first-key", "/v1/shapes"), 413, "body_too_large")
        problem(send("first-key", "/v1/search"), 413, "body_too_large")
        for path in ("/v1/shapes", "/v1/search"):
            answer = send("first-key", path)
            assert "2 uploads a minute" in problem(answer, 429, "too_many_uploads")
            assert 1 <= int(answer.headers["retry-after"]) <= 60
        assert running.client.get("/v1/shapes", headers=bearing("first-key")).status_code == 200
        problem(send("second-key", "/v1/shapes"), 413, "body_too_large")


def test_without_keys_uploads_are_not_counted(tmp_path: Path) -> None:
    with serving(settings_for(tmp_path, workers=0, uploads_per_minute=1)) as running:
        statuses = [running.add({"a.ply": coloured_triangle()}, wait=0).status_code for _ in range(3)]
    assert statuses == [202, 200, 200]


def test_keys_are_not_logged(service: Serving, caplog: pytest.LogCaptureFixture) -> None:
    _, secret = new_key(service, Scope.READ)
    with caplog.at_level(logging.DEBUG):
        service.client.get("/v1/shapes", headers=bearing(secret))
        service.client.delete("/v1/shapes/x", headers=bearing(secret))
        service.client.get("/v1/shapes", headers=bearing(f"{secret}x"))
    told = [record.getMessage() for record in caplog.records if record.name.split(".")[0] != "httpcore"]
    assert secret.split("_", 2)[2] not in "\n".join(told)  # httpcore is the test's own client


def test_a_page_of_another_site_may_not_change_anything(service: Serving) -> None:
    header = {**bearing("first-key"), "origin": "https://elsewhere.example"}
    problem(service.client.delete("/v1/shapes/x", headers=header), 403, "cross_origin")
    own = {**header, "origin": str(service.client.base_url).rstrip("/")}
    problem(service.client.delete("/v1/shapes/x", headers=own), 404, "not_found")


@pytest.mark.parametrize("asked", ["GET", "POST", "PATCH", "DELETE"])
@pytest.mark.parametrize("path", ["/v1/shapes", "/v1/shapes/x", "/v1/search", "/metrics", "/", "/docs"])
def test_no_other_site_is_let_in_to_read(service: Serving, path: str, asked: str) -> None:
    header = {**bearing("first-key"), "origin": "https://elsewhere.example"}
    preflight = {"access-control-request-method": asked, "access-control-request-headers": "authorization"}
    answers = [
        service.client.options(path, headers={"origin": header["origin"], **preflight}),
        service.client.request(asked, path, headers=header),
        service.client.request(asked, path, headers={"origin": header["origin"]}),
    ]
    assert answers[0].status_code == 405
    for answer in answers:
        assert not [name for name in answer.headers if name.startswith("access-control")]


@pytest.mark.parametrize(("insecure", "status"), [(False, 403), (True, 200)])
def test_without_keys_only_this_machines_own_names_are_answered(
    tmp_path: Path, insecure: bool, status: int
) -> None:
    with serving(settings_for(tmp_path, workers=0, insecure=insecure)) as open_service:
        port = open_service.client.base_url.port
        for host in ("127.0.0.1", f"localhost:{port}", f"[::1]:{port}"):
            assert open_service.client.get("/v1/shapes", headers={"host": host}).status_code == 200
        answer = open_service.client.get("/v1/shapes", headers={"host": "rebound.example"})
        assert answer.status_code == status
    if status == 403:
        assert "faience key create" in problem(answer, 403, "foreign_host")


def test_with_keys_any_name_is_answered(service: Serving) -> None:
    headers = {**bearing("first-key"), "host": "faience.example"}
    assert service.client.get("/v1/shapes", headers=headers).status_code == 200
