"""The service does what its description says, whatever is asked of it."""

from collections.abc import Iterator

import pytest

from soak.contract import ContractFigures, check_contract
from tests.fakes import coloured_triangle
from tests.serving import serving, settings_for

KEY = "a key that may write"
SHAPES = 9
EXAMPLES = 8  # random requests of each call; `make soak` makes many more
ROOTS = {"GET /livez", "GET /readyz", "GET /metrics", "GET /v1/methods", "GET /v1/shapes"}
PARTS = ("", "/descriptors", "/files/{name}", "/preview.glb", "/similar", "/thumbnail.png")


@pytest.fixture(scope="module")
def figures(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ContractFigures]:
    settings = settings_for(
        tmp_path_factory.mktemp("library"), workers=1, api_keys=(KEY,), uploads_per_minute=0
    )
    with serving(settings) as service:
        service.client.headers["Authorization"] = f"Bearer {KEY}"
        for red in range(SHAPES):
            assert service.add({"a.ply": coloured_triangle(red)}).status_code == 201
        yield check_contract(str(service.client.base_url), KEY, examples=EXAMPLES)


def test_nothing_contradicts_the_description(figures: ContractFigures) -> None:
    assert figures.failures == {}
    assert figures.requests > 300


def test_no_defect_is_met(figures: ContractFigures) -> None:
    for call, statuses in figures.answers.items():
        assert max(statuses) < 500, call


def test_every_call_is_reached_in_depth(figures: ContractFigures) -> None:
    for call in ROOTS | {f"GET /v1/shapes/{{shape_id}}{part}" for part in PARTS}:
        assert figures.answers[call][200] >= 3, call
    assert figures.answers["PATCH /v1/shapes/{shape_id}"][200]
    assert figures.answers["DELETE /v1/shapes/{shape_id}"][204]
    assert figures.answers["POST /v1/search"][200]
    assert figures.answers["POST /v1/shapes"][202]


def test_keys_are_demanded_and_wrong_methods_told(figures: ContractFigures) -> None:
    for call, statuses in figures.answers.items():
        if call.startswith("GET /v1"):
            assert statuses[401], call
        if call in ROOTS - {"GET /v1/shapes"}:
            assert statuses[405], call
