"""A defect is answered once, in the form of every error, and tells nothing of the inside."""

import logging
from pathlib import Path

import pytest
from starlette.types import Message, Receive, Scope, Send

from service.http.unexpected import AnswerUnexpected
from tests.asking import ask
from tests.problems import problem
from tests.serving import serving, settings_for


class Failing:
    """An application that fails, before or after it began to answer."""

    def __init__(self, started: bool) -> None:
        self._started = started

    async def __call__(self, _scope: Scope, _receive: Receive, send: Send) -> None:
        """Fail."""
        if self._started:
            start: Message = {"type": "http.response.start", "status": 200, "headers": []}
            await send(start)
        raise RuntimeError("secret")


def test_what_fails_before_its_answer_is_a_problem() -> None:
    problem(ask(AnswerUnexpected(Failing(started=False))), 500, "internal_error")


def test_what_fails_within_its_answer_is_left_to_the_server_which_cuts_it() -> None:
    with pytest.raises(RuntimeError, match="secret"):
        ask(AnswerUnexpected(Failing(started=True)))


def test_outside_nothing_is_told_of_it_and_the_log_has_it_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    with serving(settings_for(tmp_path, workers=0)) as running:

        def fail(**_: object) -> None:
            raise RuntimeError(f"secret of {__file__}")

        monkeypatch.setattr(running.library.catalogue, "list", fail)
        with caplog.at_level(logging.ERROR):
            answer = running.client.get("/v1/shapes")
        problem(answer, 500, "internal_error")
        for inside in ("secret", "RuntimeError", ".py", "line ", "service/", str(tmp_path)):
            assert inside not in answer.text
        lines = running.client.get("/metrics").text.splitlines()
    assert len([record for record in caplog.records if record.exc_info]) == 1
    assert 'faience_requests_total{method="GET",path="/v1/shapes",status="500"} 1.0' in lines
