"""Every answer says its id, and so does the log."""

import json
import logging
from collections.abc import Iterator

import pytest

from service.watching.logs import JsonLines
from tests.fakes import coloured_triangle
from tests.problems import problem
from tests.serving import Serving, serving, settings_for, wait_until

KEY = "a-key-that-is-long-enough-for-a-test"


@pytest.fixture(scope="module")
def running(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    settings = settings_for(tmp_path_factory.mktemp("library"), log="json", api_keys=KEY)
    with serving(settings) as started:
        started.client.headers["Authorization"] = f"Bearer {KEY}"
        yield started


@pytest.mark.parametrize("sent", ["order-66", "A.b_c-9", "x" * 64])
def test_a_harmless_id_is_taken_over(running: Serving, sent: str) -> None:
    answer = running.client.get("/v1/shapes/unknown", headers={"X-Request-ID": sent})
    problem(answer, 404, "not_found")
    assert answer.headers["x-request-id"] == answer.json()["request_id"] == sent


@pytest.mark.parametrize("sent", ["", "x" * 65, "a b", "<script>", '{"a":1}', "a\tb", "…".encode()])
def test_any_other_is_replaced(running: Serving, sent: str | bytes) -> None:
    value = sent if isinstance(sent, bytes) else sent.encode()
    answer = running.client.get("/v1/shapes/unknown", headers={b"X-Request-ID": value})
    made = answer.headers["x-request-id"]
    assert len(made) == 32
    assert answer.json()["request_id"] == made


def test_ids_differ_and_are_on_good_answers_too(running: Serving) -> None:
    made = {running.client.get("/livez").headers["x-request-id"] for _ in range(3)}
    assert len(made) == 3


def test_a_request_has_a_line_that_joins_its_job_and_tells_no_secret(
    running: Serving, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.handler.setFormatter(JsonLines())
    with caplog.at_level(logging.INFO):
        answer = running.add({"secret-name.ply": coloured_triangle()}, name="secret title")
        running.client.get("/v1/shapes?q=secretword", headers={"X-Request-ID": "second"})
        answered = running.client.get("/livez").headers["x-request-id"]
        wait_until(lambda: answered in caplog.text)
    lines = [json.loads(line) for line in caplog.text.splitlines() if '"logger": "service.' in line]
    shape_id = answer.json()["id"]
    (upload,) = (line for line in lines if line.get("method") == "POST")
    assert upload["route"] == "/v1/shapes"
    assert upload["status"] == answer.status_code
    assert upload["shape_id"] == shape_id
    assert upload["request_id"] == answer.headers["x-request-id"]
    assert upload["bytes"] == len(answer.content)
    assert upload["key"] == "environment"
    (job,) = (line for line in lines if line.get("outcome"))
    assert (job["outcome"], job["shape_id"]) == ("ready", shape_id)
    assert job["job_id"]
    assert [line["route"] for line in lines if line.get("request_id") == "second"] == ["/v1/shapes"]
    assert "secret" not in str(lines)
    assert KEY not in str(lines)
