"""A service whose vectors are in PostgreSQL, asked over HTTP."""

from pathlib import Path

import pytest

from tests.databases import DATABASES
from tests.fakes import coloured_triangle
from tests.serving import serving, settings_for


@pytest.mark.parametrize(("index", "exact"), [("pgvector", True), ("pgvector-hnsw", False)])
def test_new_shapes_are_found_and_an_answer_says_whether_it_is_exact(
    database_server: str, tmp_path: Path, index: str, exact: bool
) -> None:
    DATABASES.kind, DATABASES.server = "postgresql", database_server
    try:
        settings = settings_for(tmp_path, index=index)
    finally:
        DATABASES.kind = "sqlite"
    with serving(settings) as service:
        ids = [
            service.add({f"red{level}.ply": coloured_triangle(level)}).json()["id"] for level in (10, 60, 250)
        ]
        near = service.client.get(f"/v1/shapes/{ids[0]}/similar").json()
        assert [hit["shape"]["id"] for hit in near["results"]] == ids[1:]
        assert near["exact"] is exact
        weighed = service.client.get(
            f"/v1/shapes/{ids[0]}/similar", params={"weights": '{"colour-histogram": 2}'}
        ).json()
        assert weighed["exact"] is True
        assert service.client.delete(f"/v1/shapes/{ids[1]}").status_code == 204
        again = service.client.get(f"/v1/shapes/{ids[0]}/similar").json()
        assert [hit["shape"]["id"] for hit in again["results"]] == ids[2:]
