"""Who asks with a wrong method is told all the right ones."""

from collections.abc import Iterator

import pytest

from tests.problems import problem
from tests.serving import Serving, serving, settings_for


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    with serving(settings_for(tmp_path_factory.mktemp("library"), workers=0)) as running:
        yield running


@pytest.mark.parametrize(
    ("method", "path", "allowed"),
    [
        ("PUT", "/v1/shapes", {"GET", "HEAD", "POST"}),
        ("OPTIONS", "/v1/shapes/x", {"GET", "HEAD", "PATCH", "DELETE"}),
        ("POST", "/v1/shapes/x/files/folder/a.ply", {"GET", "HEAD"}),
        ("BREW", "/v1/search", {"POST"}),
        ("PUT", "/openapi.json", {"GET", "HEAD"}),
        ("DELETE", "/livez", {"GET", "HEAD"}),
    ],
)
def test_a_wrong_method_is_told_the_right_ones(
    service: Serving, method: str, path: str, allowed: set[str]
) -> None:
    answer = service.client.request(method, path)
    problem(answer, 405, "method_not_allowed")
    assert set(answer.headers["allow"].split(", ")) == allowed
