"""The form in which errors leave: `application/problem+json` (RFC 9457) with a stable code."""

from http import HTTPStatus
from typing import Any

from starlette.responses import JSONResponse

from service.watching.context import known

MEDIA_TYPE = "application/problem+json"
RETRY_SECONDS = "2"  # what a busy service asks for

# Of errors that the framework finds itself; our own exceptions carry their codes.
PLAIN_CODES = {
    400: "bad_request",
    404: "not_found",
    405: "method_not_allowed",
    408: "slow_request",
    413: "body_too_large",
    416: "range_not_satisfiable",
    431: "headers_too_large",
    503: "busy",
}


def problem(status: int, *, code: str, title: str, detail: str, **more: Any) -> JSONResponse:
    """Return an answer of RFC 9457.

    Parameters
    ----------
    code : str
        Stable; clients may rely on it.
    title, detail : str
        The kind of error, and this one, in words.
    **more
        Further members.
    """
    body = {"type": f"urn:faience:problem:{code}", "title": title, "status": int(status), "detail": detail}
    request_id = known().get("request_id")  # none where what came was no request
    about = {} if request_id is None else {"request_id": request_id}
    response = JSONResponse({**body, "code": code, **about, **more}, int(status), media_type=MEDIA_TYPE)
    if status == HTTPStatus.UNAUTHORIZED:
        response.headers["WWW-Authenticate"] = "Bearer"
    if status == HTTPStatus.SERVICE_UNAVAILABLE:
        response.headers["Retry-After"] = RETRY_SECONDS
    return response


def plain_problem(status: int) -> JSONResponse:
    """Return the answer for an error of which only the status is known."""
    phrase = HTTPStatus(status).phrase
    code = PLAIN_CODES.get(status, f"http_{status}")
    return problem(status, code=code, title=phrase, detail=HTTPStatus(status).description or phrase)
