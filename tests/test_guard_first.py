"""Without a key not even the form of a body is judged."""

from collections.abc import Iterator

import pytest
from pydantic import SecretStr

from tests.problems import problem
from tests.serving import Serving, serving, settings_for

KEY = {"authorization": "Bearer a-long-secret"}


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    folder = tmp_path_factory.mktemp("library")
    settings = settings_for(folder, workers=0, api_keys=(SecretStr("a-long-secret"),), uploads_per_minute=2)
    with serving(settings) as running:
        yield running


@pytest.mark.parametrize("body", [b"{", b"\xff", b"[1]", b'{"name": 3}'])
def test_a_body_that_would_be_refused_is_not_looked_at_without_a_key(service: Serving, body: bytes) -> None:
    header = {"content-type": "application/json"}
    with_key = service.client.patch("/v1/shapes/x", content=body, headers=header | KEY)
    assert with_key.status_code in (400, 422)
    problem(service.client.patch("/v1/shapes/x", content=body, headers=header), 401, "unauthorised")


def test_an_upload_is_counted_once(service: Serving) -> None:
    for _ in range(2):
        assert service.client.post("/v1/shapes", headers=KEY).status_code == 415
    problem(service.client.post("/v1/shapes", headers=KEY), 429, "too_many_uploads")
