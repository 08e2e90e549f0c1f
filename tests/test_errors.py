"""One table says what every exception becomes, and nothing inside is told outside."""

from pathlib import Path

import pytest

from service.http.errors import CODES, TABLE
from tests.exceptions import INSIDE, exceptions_with_codes
from tests.problems import problem
from tests.serving import serving, settings_for
from worker.errors import MeshError


def test_every_exception_that_users_can_cause_is_in_the_table() -> None:
    for kind in exceptions_with_codes() - INSIDE:
        assert any(parent in TABLE for parent in kind.__mro__), kind


def test_every_row_has_a_stable_code() -> None:
    for kind in set(TABLE) - {MeshError}:
        code = CODES.get(kind) or getattr(kind, "code", None)
        assert isinstance(code, str)
        assert code == code.lower()
        assert " " not in code


@pytest.mark.parametrize("error", [KeyError("secret"), RuntimeError("secret"), OSError(5, "secret")])
def test_what_nobody_expected_is_a_problem_without_its_inside(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    with serving(settings_for(tmp_path, workers=0)) as running:

        def fail(*_: object) -> None:
            raise error

        monkeypatch.setattr(running.library.catalogue, "get", fail)
        answer = running.client.get("/v1/shapes/x")
        problem(answer, 500, "internal_error")
        assert "secret" not in answer.text


def test_invalid_requests_are_not_repeated_in_the_answer(tmp_path: Path) -> None:
    with serving(settings_for(tmp_path, workers=0)) as running:
        answer = running.client.get("/v1/shapes", params={"limit": "very-secret"})
        problem(answer, 422, "invalid_request")
        assert "very-secret" not in answer.text
        assert answer.json()["errors"][0]["where"] == "query.limit"
