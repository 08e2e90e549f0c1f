"""Processes of one library are restarted in turn, and nobody who asks notices."""

from pathlib import Path
from typing import Any

import pytest

from index.shapes import Status
from service.asking import Question
from service.intake.submissions import receive_paths
from service.jobs.recording import record_description
from service.library import Library
from service.retrieval import accept_upload, find_similar
from soak.processes import ending, free_port, serve
from soak.rolling import Backend, roll
from tests.fakes import coloured_triangle, describe_quickly
from tests.serving import open_fake_library, settings_for

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL

SHAPES = 6


def filled(library: Library, folder: Path) -> list[str]:
    """Return the ids of ready shapes of different colours."""
    path = folder / "a.ply"
    for number in range(SHAPES):
        path.write_bytes(coloured_triangle(40 * number))
        accept_upload(library, receive_paths({"a.ply": path}))
        job = library.queue.claim("test", 600)
        assert job is not None
        described = describe_quickly({"a.ply": path.read_bytes()}, True, library.parameters, library.limits)
        record_description(library, job, described)
    return [shape.id for shape in library.catalogue.list(limit=50, status=Status.READY).items]


def ranked(answer: Any) -> list[tuple[str, float]]:
    return [(hit["shape"]["id"], round(hit["distance"], 9)) for hit in answer["results"]]


def test_a_rolling_restart_fails_no_query_and_answers_none_wrongly(tmp_path: Path) -> None:
    settings = settings_for(tmp_path / "library")
    library = open_fake_library(settings)
    expected = {
        f"/v1/shapes/{shape_id}/similar": [
            (hit.shape.id, round(hit.distance, 9)) for hit in find_similar(library, shape_id, Question()).hits
        ]
        for shape_id in filled(library, tmp_path)
    }
    library.close()
    assert len(expected) == SHAPES
    environment = {"FAIENCE_DRAIN_SECONDS": "3600", "FAIENCE_DATABASE_URL": settings.url}
    ports = [free_port(), free_port()]
    backends = [Backend(command=serve(settings.data_dir, port, 0, environment), port=port) for port in ports]
    with ending(*(each.command for each in backends)):
        figures = roll(backends, expected, ranked)
    assert figures.broken == ()
    assert figures.restarts == 2
    assert figures.queries >= 30
