"""Every error of the program is described by its code, where it may come and with what to do about it."""

import string
from pathlib import Path
from typing import Any

import pytest

from index.errors import NotFailed
from service.app import create_app
from service.http.errors import TABLE
from service.http.meanings import MEANINGS
from service.http.problems import PLAIN_CODES
from service.http.reasons import FAILURES, all_codes, by_status, codes_of
from service.intake.multipart import UploadRefused
from service.jobs.recording import GAVE_UP, UNEXPECTED
from tests.exceptions import INSIDE, exceptions_with_codes
from tests.serving import settings_for
from worker.errors import Code, MeshError

OF_NO_CALL = {NotFailed}  # the queue has it, and no call asks for another try


@pytest.fixture(scope="module")
def interface() -> dict[str, Any]:
    return create_app(settings_for(Path("unused"))).openapi()


def codes_by_call(interface: dict[str, Any]) -> dict[str, dict[str, list[str]]]:
    """Return operation → status → codes."""
    found = {}
    for methods in interface["paths"].values():
        for call in methods.values():
            found[call["operationId"]] = {
                status: answer["content"]["application/problem+json"]["schema"]["allOf"][1]["properties"][
                    "code"
                ]["enum"]
                for status, answer in call["responses"].items()
                if int(status) >= 400
            }
    return found


def test_every_code_of_the_program_is_in_the_interface(interface: dict[str, Any]) -> None:
    described = set(interface["components"]["schemas"]["ProblemModel"]["properties"]["code"]["enum"])
    raised = {kind.code for kind in exceptions_with_codes() - INSIDE - {UploadRefused}}  # type: ignore[attr-defined] # that is how they were chosen
    assert raised | set(Code) | set(PLAIN_CODES.values()) <= described


def test_every_exception_of_the_table_comes_with_some_call(interface: dict[str, Any]) -> None:
    told = {
        (int(status), code)
        for call in codes_by_call(interface).values()
        for status, codes in call.items()
        for code in codes
    }
    for kind in set(TABLE) - OF_NO_CALL - {UploadRefused}:
        assert set(codes_of(kind)) <= told, kind


def test_why_shapes_fail_is_described(interface: dict[str, Any]) -> None:
    failure = interface["components"]["schemas"]["FailureModel"]["properties"]["code"]
    assert set(failure["enum"]) == {*Code, GAVE_UP, UNEXPECTED} == set(FAILURES)


def test_every_code_has_a_meaning_and_no_other() -> None:
    codes = {code for codes in all_codes().values() for code in codes}
    assert codes | set(FAILURES) == set(MEANINGS)
    for code, meaning in MEANINGS.items():
        assert meaning[0] in string.ascii_uppercase, code
        assert meaning.endswith("."), code
        assert meaning.count(". ") + meaning.count(": ") + meaning.count("; ") >= 1, code  # and what to do


def test_the_manual_of_codes_is_in_the_description(interface: dict[str, Any]) -> None:
    text = interface["components"]["schemas"]["ProblemModel"]["properties"]["code"]["description"]
    for codes in all_codes().values():
        for code in codes:
            assert f"* `{code}`: {MEANINGS[code]}" in text


@pytest.mark.parametrize(
    ("call", "status", "code"),
    [
        ("addShape", "422", "missing_texture"),
        ("addShape", "422", "bad_metadata"),
        ("addShape", "429", "too_many_uploads"),
        ("addShape", "507", "storage_full"),
        ("changeShape", "413", "body_too_large"),
        ("findSimilar", "409", "not_ready"),
        ("listShapes", "422", "bad_cursor"),
        ("searchByMesh", "503", "too_busy"),
        ("searchByMesh", "422", "gave_up"),
        ("downloadFile", "416", "range_not_satisfiable"),
        ("metrics", "401", "unauthorised"),
        ("live", "500", "internal_error"),
    ],
)
def test_a_call_tells_its_own_errors(interface: dict[str, Any], call: str, status: str, code: str) -> None:
    assert code in codes_by_call(interface)[call][status]


def test_a_call_tells_no_errors_of_others(interface: dict[str, Any]) -> None:
    calls = codes_by_call(interface)
    assert "missing_texture" not in calls["listShapes"]["422"]
    assert "read_only_key" not in calls["getShape"]["403"]
    assert "409" not in calls["addShape"]


def test_a_status_has_each_code_once() -> None:
    assert by_status((MeshError, MeshError, 400)) == {400: ["bad_request"], 422: sorted(Code)}
