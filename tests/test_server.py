"""The whole service as a process: real meshes, kills, clean stops."""

import contextlib
import io
import os
import signal
import subprocess
import sys
import threading
import zipfile
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from service.intake.submissions import receive_paths
from service.listening import UnsafeListening
from service.retrieval import accept_upload
from service.server import run_server, run_worker
from service.settings import Settings
from soak.processes import alive, descendants
from tests.fakes import coloured_triangle
from tests.serving import open_fake_library, settings_for, wait_until
from tests.small_library import good_mesh
from worker.stages import STAGES

ROOT = Path(__file__).parents[1]
SCRIPT = """
import sys
from service.server import run_server
from service.settings import Settings
from soak.processes import alive, descendants
run_server(Settings(port=0), 2, False, lambda line: print(line, flush=True))
"""


@contextlib.contextmanager
def running(folder: Path) -> Iterator[tuple[subprocess.Popen[str], httpx.Client]]:
    """Run the service in a process of its own; kill it at the end if it still runs."""
    environment = {
        **os.environ,
        "PYTHONPATH": str(ROOT),
        "FAIENCE_DATA_DIR": str(folder),
        "FAIENCE_LEASE_SECONDS": "2",
    }
    service = subprocess.Popen(
        [sys.executable, "-c", SCRIPT], env=environment, stdout=subprocess.PIPE, text=True
    )
    try:
        with service, httpx.Client(base_url=address(service), timeout=300) as client:
            try:
                yield service, client
            finally:
                service.kill()
    finally:
        service.kill()


def address(service: subprocess.Popen[str]) -> str:
    """Read where the service says it is."""
    line = service.stdout.readline() if service.stdout else ""
    return next(word for word in line.split() if word.startswith("http://"))


def files_of(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir()) if path.is_file()}


def test_textured_meshes_are_described_and_found_again_through_every_door(
    data_folder: Path, tmp_path: Path
) -> None:
    with running(tmp_path) as (_, client):
        for name in ("mug", "axe"):
            parts = [("files", part) for part in files_of(data_folder / "textured" / name).items()]
            answer = client.post("/v1/shapes", params={"wait": 240}, files=parts, data={"name": name})
            assert answer.status_code == 201, answer.text
            assert answer.json()["mesh"]["colour"] == "texture"
        parcel = io.BytesIO()
        with zipfile.ZipFile(parcel, "w") as archive:
            for name, content in files_of(data_folder / "textured" / "mug").items():
                archive.writestr(f"folder/{name}", content)
        query = [("files", ("query.zip", parcel.getvalue()))]
        found = client.post("/v1/search", files=query).json()
        assert [hit["shape"]["name"] for hit in found["results"]] == ["mug", "axe"]
        assert found["results"][0]["distance"] == pytest.approx(0, abs=1e-6)
        path = f"/v1/shapes/{found['results'][0]['shape']['id']}"
        assert client.get(f"{path}/thumbnail.png").content[:4] == b"\x89PNG"
        assert client.get(f"{path}/preview.glb").content[:4] == b"glTF"


def test_what_was_acknowledged_survives_kill_9_and_becomes_ready(tmp_path: Path) -> None:
    with running(tmp_path) as (service, client):
        answer = client.post("/v1/shapes", files=[("files", ("a.ply", coloured_triangle()))])
        assert answer.status_code == 202
        path = answer.headers["location"]
        wait_until(lambda: client.get(path).json()["status"] != "queued")
        family = descendants(service.pid)
        service.kill()
        wait_until(lambda: not any(alive(pid) for pid in family))
    with running(tmp_path) as (_, client):
        wait_until(lambda: client.get(path).json()["status"] in ("ready", "failed"))
        assert client.get(path).json()["status"] == "ready"
        assert client.get(f"{path}/files/a.ply").content == coloured_triangle()
        assert len(client.get("/v1/shapes").json()["items"]) == 1


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_stop_is_clean_gives_jobs_back_and_leaves_no_process(
    tmp_path: Path, number: signal.Signals
) -> None:
    with running(tmp_path) as (service, client):
        path = client.post("/v1/shapes", files=[("files", ("a.ply", coloured_triangle()))]).headers[
            "location"
        ]
        wait_until(lambda: client.get(path).json()["status"] != "queued")
        family = descendants(service.pid)
        with client.stream("GET", "/v1/events") as events:  # a listener must not hold up the stop
            assert events.status_code == 200
            service.send_signal(number)
            assert service.wait(timeout=60) in (0, -number)
        wait_until(lambda: not any(alive(pid) for pid in family))
    library = open_fake_library(settings_for(tmp_path))
    assert library.catalogue.get(path.rpartition("/")[2]).status in ("queued", "ready")
    library.close()


@pytest.mark.parametrize("host", ["0.0.0.0", "::"])  # noqa: S104
def test_other_machines_are_not_let_in_without_a_key(host: str, tmp_path: Path) -> None:
    with pytest.raises(UnsafeListening):
        run_server(Settings(host=host, data_dir=tmp_path / "library"), 0, False)
    assert not (tmp_path / "library").exists()


def test_a_worker_alone_works_on_the_queue_until_it_is_stopped_and_tells_its_numbers(tmp_path: Path) -> None:
    settings = settings_for(tmp_path / "library", metrics_port=0)
    library = open_fake_library(settings)
    sent = tmp_path / "a.ply"
    sent.write_bytes(good_mesh(1)["good.ply"])
    shape, _ = accept_upload(library, receive_paths({"a.ply": sent}))
    stop, lines = threading.Event(), list[str]()
    worker = threading.Thread(target=run_worker, args=(settings, 1, stop, lines.append))
    worker.start()
    try:
        wait_until(lambda: library.catalogue.get(shape.id).status in ("ready", "failed"))
        (url,) = (word for line in lines for word in line.split() if word.startswith("http://127.0.0.1:"))
        wait_until(lambda: "faience_jobs_total{" in httpx.get(url).text)
        numbers = httpx.get(url).text
    finally:
        stop.set()
        worker.join()
    assert library.catalogue.get(shape.id).status == "ready"
    library.close()
    for stage in (*STAGES, "recording"):
        assert f'faience_job_stage_seconds_count{{stage="{stage}"}} 1.0' in numbers
    assert "faience_queue_depth 0.0" in numbers
    with pytest.raises(httpx.ConnectError):
        httpx.get(url)
