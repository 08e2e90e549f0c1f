"""Files of shapes as answers: ranges, addresses in a bucket, and a storage that is away."""

from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from index import object_client
from service.jobs.sweeping import sweep
from tests.fakes import coloured_triangle
from tests.faulty_storage import Door, door
from tests.problems import problem
from tests.serving import Serving, serving, settings_for, wait_until
from tests.storages import PLACES

PIECE = 4 << 20  # bytes that are fetched at once
LONG = bytes(range(251)) * 40_000  # three pieces


@pytest.fixture(scope="module")
def service(storage: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    with serving(settings_for(tmp_path_factory.mktemp("library"))) as running:
        yield running


@pytest.fixture(scope="module")
def address(service: Serving) -> str:
    path = service.add({"a.ply": coloured_triangle(), "long": LONG}).headers["location"]
    return f"{path}/files/long"


@pytest.mark.parametrize(
    ("asked", "start", "stop"),
    [
        ("bytes=0-9", 0, 10),
        ("bytes=-7", len(LONG) - 7, len(LONG)),
        (f"bytes={PIECE - 1}-{PIECE}", PIECE - 1, PIECE + 1),
        ("bytes=5-", 5, len(LONG)),
        (f"bytes=10-{len(LONG) + 10}", 10, len(LONG)),
    ],
)
def test_a_range_is_answered_alone(service: Serving, address: str, asked: str, start: int, stop: int) -> None:
    answer = service.client.get(address, headers={"range": asked})
    assert (answer.status_code, answer.content) == (206, LONG[start:stop])
    assert answer.headers["content-range"] == f"bytes {start}-{stop - 1}/{len(LONG)}"
    assert answer.headers["content-length"] == str(stop - start)
    assert answer.headers["content-disposition"] == 'attachment; filename="long"'


def test_several_ranges_come_in_one_answer(service: Serving, address: str) -> None:
    answer = service.client.get(address, headers={"range": "bytes=0-3,100-103"})
    assert answer.status_code == 206
    assert answer.headers["content-type"].startswith("multipart/byteranges")
    assert LONG[:4] in answer.content
    assert LONG[100:104] in answer.content


def test_the_whole_comes_with_what_is_known_of_it(service: Serving, address: str) -> None:
    answer = service.client.get(address)
    assert (answer.status_code, answer.content) == (200, LONG)
    assert answer.headers["content-length"] == str(len(LONG))
    assert {"etag", "last-modified", "accept-ranges"} <= answer.headers.keys()
    head = service.client.head(address)
    assert (head.status_code, head.content, head.headers["etag"]) == (200, b"", answer.headers["etag"])


def test_a_download_can_be_resumed_while_the_file_is_the_same(service: Serving, address: str) -> None:
    etag = service.client.get(address).headers["etag"]
    rest = service.client.get(address, headers={"range": "bytes=100-", "if-range": etag})
    assert (rest.status_code, rest.content) == (206, LONG[100:])
    other = service.client.get(address, headers={"range": "bytes=100-", "if-range": '"another"'})
    assert (other.status_code, other.content) == (200, LONG)


def test_a_file_that_is_gone_is_a_problem(service: Serving) -> None:
    path = service.add({"a.ply": coloured_triangle(red=7)}).headers["location"]
    shape = service.library.catalogue.get(path.rpartition("/")[2])
    service.library.files.delete(shape.files[0].key)
    problem(service.client.get(f"{path}/files/a.ply"), 404, "file_missing")


@pytest.fixture
def storage_door(
    object_server: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> Iterator[tuple[Serving, Door]]:
    """Serve a library whose bucket lies behind a door; by signed addresses where a test asks for it."""
    presigned: bool = getattr(request, "param", False)
    monkeypatch.setattr(object_client, "RETRIES", 0)
    monkeypatch.setattr(PLACES, "kind", "s3")
    with door(object_server) as opened:
        monkeypatch.setenv("AWS_ENDPOINT_URL", opened.address)
        settings = settings_for(tmp_path / "library", presigned=presigned, lease_seconds=0.5)
        with serving(settings) as running:
            yield running, opened


@pytest.mark.parametrize("storage_door", [True], indirect=True)
def test_where_it_is_wished_files_are_fetched_from_the_bucket_itself(
    storage_door: tuple[Serving, Door],
) -> None:
    service, _ = storage_door
    path = service.add({"a.ply": coloured_triangle()}).headers["location"]
    told = service.client.get(f"{path}/files/a.ply")
    assert (told.status_code, told.headers["cache-control"]) == (307, "no-store")
    answer = httpx.get(told.headers["location"])
    assert answer.content == coloured_triangle()
    assert answer.headers["content-disposition"] == "attachment"
    assert answer.headers["content-type"] == "application/octet-stream"
    preview = httpx.get(service.client.get(f"{path}/preview.glb").headers["location"])
    assert (preview.headers["content-type"], preview.content[:4]) == ("model/gltf-binary", b"glTF")
    assert service.client.get(f"{path}/thumbnail.png").content[:4] == b"\x89PNG"
    problem(service.client.get(f"{path}/files/b.ply"), 404, "file_missing")


def test_who_asks_for_the_head_alone_moves_no_bytes(storage_door: tuple[Serving, Door]) -> None:
    service, opened = storage_door
    path = service.add({"a.ply": coloured_triangle(), "long": LONG}).headers["location"]
    del opened.asked[:]
    answer = service.client.head(f"{path}/files/long")
    assert (answer.status_code, answer.headers["content-length"]) == (200, str(len(LONG)))
    assert [method for method, _ in opened.asked] == ["HEAD"]
    assert service.client.get(f"{path}/files/long").content == LONG
    assert [method for method, _ in opened.asked] == ["HEAD", "HEAD", *3 * ["GET"]]


@pytest.mark.parametrize("status", [500, 0])
def test_an_upload_while_the_storage_is_away_leaves_nothing_and_can_be_repeated(
    storage_door: tuple[Serving, Door], status: int
) -> None:
    service, opened = storage_door
    opened.fault = lambda method, _path: status if method == "PUT" else None
    refused = service.add({"a.ply": coloured_triangle()})
    problem(refused, 503, "storage_unreachable")
    assert int(refused.headers["retry-after"]) > 0
    assert service.client.get("/v1/shapes").json()["items"] == []
    opened.open()
    assert list(service.library.files.keys()) == []
    assert service.add({"a.ply": coloured_triangle()}).status_code == 201


def test_a_job_loses_no_attempt_while_the_storage_is_away(storage_door: tuple[Serving, Door]) -> None:
    service, opened = storage_door
    refused: list[str] = []

    def away(method: str, path: str) -> int | None:
        refused.append(path)
        return 500 if method == "GET" and "uploads" in path else None

    opened.fault = away
    location = service.add({"a.ply": coloured_triangle()}, wait=0).headers["location"]
    wait_until(lambda: sum("uploads" in path for path in refused) > 7)  # more than a job has attempts
    shape_id = location.rpartition("/")[2]
    assert service.shape(shape_id)["status"] in ("queued", "processing")
    opened.open()
    assert service.settled(shape_id)["status"] == "ready"


def test_what_is_known_without_files_is_answered_while_the_storage_is_away(
    storage_door: tuple[Serving, Door],
) -> None:
    service, opened = storage_door
    path = service.add({"a.ply": coloured_triangle()}).headers["location"]
    opened.close()
    assert service.client.get(path).status_code == 200
    problem(service.client.get(f"{path}/preview.glb"), 503, "storage_unreachable")
    problem(service.client.get(f"{path}/thumbnail.png"), 503, "storage_unreachable")


def test_a_shape_is_removed_although_its_files_must_wait_for_the_sweeper(
    storage_door: tuple[Serving, Door],
) -> None:
    service, opened = storage_door
    path = service.add({"a.ply": coloured_triangle()}).headers["location"]
    opened.close()
    assert service.client.delete(path).status_code == 204
    problem(service.client.get(path), 404, "not_found")
    opened.open()
    assert len(list(service.library.files.keys())) == 4
    assert sweep(service.library, older_than=-1) == 4
    assert list(service.library.files.keys()) == []
