"""One table says what every exception becomes, and nothing inside is told outside."""

import importlib
import inspect
import pkgutil
from pathlib import Path

import pytest

import index
import service
from index.errors import (
    BadKeyName,
    CatalogueError,
    DamagedExport,
    DamagedIndex,
    ExportRefused,
    KeyNotFound,
    LeaseLost,
    LibraryNotEmpty,
    NewerFormat,
    UnknownVocabulary,
)
from service.http.errors import CODES, TABLE
from tests.problems import problem
from tests.serving import serving, settings_for
from worker.errors import MeshError

EXPORTS = {ExportRefused, DamagedExport, NewerFormat, LibraryNotEmpty}
# Never reach a request: they belong to workers, to indexes that are built anew, and to the command line.
INSIDE = {CatalogueError, LeaseLost, DamagedIndex, UnknownVocabulary, KeyNotFound, BadKeyName, *EXPORTS}


def exceptions_with_codes() -> set[type[Exception]]:
    """Return every exception class of service and index that carries a code."""
    found: set[type[Exception]] = set()
    for package in (service, index):
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if ".commands" in module.name or ".migrations" in module.name or module.name.endswith("preload"):
                continue
            members = inspect.getmembers(importlib.import_module(module.name), inspect.isclass)
            found |= {
                each
                for _, each in members
                if issubclass(each, Exception)
                and isinstance(getattr(each, "code", None), str)
                and each.__module__.split(".")[0] in ("service", "index")
            }
    return found


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
