"""Whatever the framework answers, an error leaves as a problem, and everything else untouched."""

import httpx
from starlette.responses import PlainTextResponse, Response

from service.http.headers import SAFE_HEADERS, AddSafeHeaders
from service.http.plain_errors import ReplacePlainErrors
from service.http.problems import plain_problem
from tests.asking import ask
from tests.problems import problem


def outside(answer: Response) -> httpx.Response:
    return ask(AddSafeHeaders(ReplacePlainErrors(answer)))


def test_a_plain_error_is_replaced_and_keeps_what_clients_need() -> None:
    plain = PlainTextResponse("inner words", 416, headers={"content-range": "bytes */5"})
    answer = outside(plain)
    problem(answer, 416, "range_not_satisfiable")
    assert "inner words" not in answer.text
    assert answer.headers["content-range"] == "bytes */5"
    assert answer.headers["content-length"] == str(len(answer.content))


def test_an_unlisted_status_has_a_code_too() -> None:
    problem(outside(PlainTextResponse("x", 418)), 418, "http_418")


def test_a_problem_and_a_success_pass_unchanged() -> None:
    assert outside(PlainTextResponse("fine")).text == "fine"
    own = plain_problem(404)
    assert outside(own).content == own.body


def test_safe_headers_are_added_and_an_answers_own_are_kept() -> None:
    answer = outside(PlainTextResponse("fine", headers={"Content-Security-Policy": "sandbox"}))
    assert answer.headers["content-security-policy"] == "sandbox"
    for name in set(SAFE_HEADERS) - {"Content-Security-Policy"}:
        assert answer.headers[name] == SAFE_HEADERS[name]
