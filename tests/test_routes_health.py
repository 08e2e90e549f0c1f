"""Health and metrics tell the truth."""

from datetime import timedelta
from pathlib import Path

import pytest
from sqlalchemy import update
from sqlalchemy.exc import OperationalError

from index.database import writing
from index.revisions import now
from index.tables import JobRow
from tests.fakes import coloured_triangle
from tests.problems import problem
from tests.serving import serving, settings_for, wait_until

PARTS = ("catalogue", "files", "descriptions", "keys", "index")
WELL = dict.fromkeys(PARTS, "ok") | {"worker": "is none here"}


def test_ready_names_each_part_and_the_one_that_is_not(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("service.watching.readiness.KEPT_SECONDS", 0.0)
    with serving(settings_for(tmp_path, workers=0)) as running:
        assert running.client.get("/livez").json() == {"status": "ok"}
        wait_until(lambda: running.client.get("/readyz").status_code == 200)  # the index is loaded
        assert running.client.get("/readyz").json() == {"status": "ok", "parts": WELL}

        def away() -> int:
            raise OperationalError("SELECT", {}, Exception("secret host is away"))

        monkeypatch.setattr(running.library.catalogue, "revision", away)
        answer = running.client.get("/readyz")
        assert "catalogue cannot be used" in problem(answer, 503, "unready")
        assert "secret" not in answer.text
        assert {name for name, words in answer.json()["parts"].items() if words != "ok"} == {"catalogue"}
        assert answer.headers["retry-after"]
        assert running.client.get("/livez").status_code == 200


def test_the_worker_is_told_of(tmp_path: Path) -> None:
    with serving(settings_for(tmp_path)) as running:
        wait_until(lambda: running.client.get("/readyz").status_code == 200)
        assert running.client.get("/readyz").json()["parts"]["worker"] == "ok"


def test_a_process_that_was_told_to_end_is_not_ready_and_still_answers(tmp_path: Path) -> None:
    with serving(settings_for(tmp_path, workers=0)) as running:
        running.services.readiness.shutting_down = True
        problem(running.client.get("/readyz"), 503, "shutting_down")
        assert running.client.get("/v1/shapes").status_code == 200


def test_metrics_count_requests_by_route_and_jobs_by_outcome(tmp_path: Path) -> None:
    with serving(settings_for(tmp_path)) as running:
        path = running.add({"a.ply": coloured_triangle()}).headers["location"]
        running.client.get(path)
        running.client.get("/v1/shapes/unknown")
        running.client.get(f"{path}/files/a.ply")
        running.client.get("/no/such/path")
        lines = running.client.get("/metrics").text.splitlines()
    for line in (
        'faience_requests_total{method="POST",path="/v1/shapes",status="201"} 1.0',
        'faience_requests_total{method="GET",path="/v1/shapes/{shape_id}",status="200"} 1.0',
        'faience_requests_total{method="GET",path="/v1/shapes/{shape_id}",status="404"} 1.0',
        'faience_requests_total{method="GET",path="/v1/shapes/{shape_id}/files/{name}",status="200"} 1.0',
        'faience_requests_total{method="GET",path="unknown",status="404"} 1.0',
        'faience_jobs_total{outcome="ready"} 1.0',
        'faience_shapes{status="ready"} 1.0',
        "faience_queue_depth 0.0",
        "faience_queue_age_seconds 0.0",
    ):
        assert line in lines


def test_metrics_tell_how_long_the_oldest_job_waits(tmp_path: Path) -> None:
    with serving(settings_for(tmp_path, workers=0)) as running:
        running.add({"a.ply": coloured_triangle()}, wait=0)
        with writing(running.library.engine) as session:
            session.execute(update(JobRow).values(queued_at=now() - timedelta(seconds=100)))
        lines = running.client.get("/metrics").text.splitlines()
    (age,) = (line.split()[1] for line in lines if line.startswith("faience_queue_age_seconds "))
    assert 100 <= float(age) < 200
