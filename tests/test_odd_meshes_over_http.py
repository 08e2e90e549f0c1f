"""What the tables promise of odd meshes holds through HTTP, and harms no good mesh sent between them."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import pytest

from service.jobs.describing import describe_files
from tests.odd_meshes import ODD, OddMesh, odd_meshes
from tests.problems import problem
from tests.serving import Serving, serving, settings_for
from tests.small_library import good_mesh, open_small_library
from worker.errors import MeshError
from worker.reading.upload import Upload, inspect_upload

TABLES = ("MADE.tsv", "REAL.tsv")
GOOD_EVERY = 5  # rows
CLIENTS = 6  # at the same time


@dataclass(frozen=True, kw_only=True)
class Sent:
    """What became of everything that was sent."""

    service: Serving
    rows: dict[str, httpx.Response]  # by table and entry
    good: list[httpx.Response]
    settled: dict[str, dict[str, Any]]  # every shape of the library, by id


@pytest.fixture(scope="module")
def sent(odd_meshes_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Sent]:
    """Send every row, a good mesh after every few, by several clients at once; wait for all."""
    assert odd_meshes_folder == ODD
    settings = settings_for(tmp_path_factory.mktemp("library"), workers=2)
    with serving(settings, describe_files, open_small_library) as service:
        rows = odd_meshes(*TABLES)
        uploads = [row.files for row in rows]
        for number in reversed(range(0, len(rows), GOOD_EVERY)):
            uploads.insert(number, good_mesh(1000 + number))
        with ThreadPoolExecutor(CLIENTS) as clients:
            answers = list(clients.map(lambda files: service.add(files, wait=0), uploads))
        good = [answers.pop(number) for number in reversed(good_places(len(rows)))]
        kept = [answer.json()["id"] for answer in answers + good if answer.is_success]
        yield Sent(
            service=service,
            rows={key(row): answer for row, answer in zip(rows, answers, strict=True)},
            good=good,
            settled={shape_id: service.settled(shape_id) for shape_id in kept},
        )


def good_places(n_rows: int) -> list[int]:
    """Return where the good meshes stand among everything that is sent."""
    return [number + place for place, number in enumerate(range(0, n_rows, GOOD_EVERY))]


def key(row: OddMesh) -> str:
    return f"{row.table} {row.entry}"


def told_by_headers(row: OddMesh) -> bool:
    try:
        inspect_upload(Upload(files=row.files))
    except MeshError:
        return True
    return False


@pytest.mark.parametrize("row", odd_meshes(*TABLES), ids=key)
def test_every_row_has_its_outcome_and_code(sent: Sent, row: OddMesh) -> None:
    answer = sent.rows[key(row)]
    assert answer.is_client_error == told_by_headers(row), answer.text
    if answer.is_client_error:
        code = answer.json()["code"]
        assert problem(answer, 422, code)
        assert code in row.codes
        return
    assert answer.status_code in {200, 202}  # 200: some rows have the same content
    shape = sent.settled[answer.json()["id"]]
    if row.accepted:
        assert (shape["status"], shape["error"]) == ("ready", None)
        assert row.colour in {None, shape["mesh"]["colour"]}
    else:
        assert (shape["status"], shape["mesh"]) == ("failed", None)
        assert shape["error"]["code"] in row.codes
        assert shape["error"]["detail"]


def test_every_good_mesh_between_them_is_ready_and_finds_the_others(sent: Sent) -> None:
    assert {answer.status_code for answer in sent.good} == {202}
    ids = {answer.json()["id"] for answer in sent.good}
    assert len(ids) == len(sent.good)
    assert {sent.settled[shape_id]["status"] for shape_id in ids} == {"ready"}
    ready = {shape_id for shape_id, shape in sent.settled.items() if shape["status"] == "ready"}
    for shape_id in ids:
        answer = sent.service.client.get(f"/v1/shapes/{shape_id}/similar", params={"limit": 1000})
        found = {result["shape"]["id"] for result in answer.json()["results"]}
        assert found == ready - {shape_id}


def test_what_was_refused_in_the_reply_left_nothing(sent: Sent) -> None:
    page = sent.service.client.get("/v1/shapes", params={"limit": 500}).json()
    assert {shape["id"] for shape in page["items"]} == sent.settled.keys()
    assert page["next_cursor"] is None
    assert [path.name for path in sent.service.library.incoming.folder.iterdir()] == [".lock"]
    uploads = sent.service.library.settings.data_dir / "files" / "uploads"
    assert len(list(uploads.iterdir())) == len(sent.settled)


def test_a_search_by_every_tenth_row_has_the_same_outcome_and_code(sent: Sent) -> None:
    for row in odd_meshes(*TABLES)[::10]:
        files = [("files", part) for part in row.files.items()]
        answer = sent.service.client.post("/v1/search", files=files)
        assert (answer.status_code == 200) == row.accepted
        if not row.accepted:
            assert problem(answer, 422, answer.json()["code"])
            assert answer.json()["code"] in row.codes
