"""Shapes over HTTP: every call, every status."""

import io
import json
import zipfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from uuid import UUID

import pytest

from tests.fakes import coloured_triangle
from tests.problems import problem
from tests.serving import Serving, serving, settings_for

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL

OBJ = b"mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\nf 1/1 2/1 4/1\n"


@pytest.fixture(scope="module")
def service(database: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    with serving(settings_for(tmp_path_factory.mktemp("library"))) as running:
        yield running


@pytest.fixture(scope="module")
def idle(database: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    """Run a service without a worker: shapes stay queued."""
    with serving(settings_for(tmp_path_factory.mktemp("idle"), workers=0, max_body_bytes=100_000)) as running:
        yield running


def kept(running: Serving) -> list[str]:
    """Return every file under the data folder that belongs to an upload."""
    root = running.library.settings.data_dir
    folders = (root / "files", root / "incoming")
    return [
        str(path)
        for folder in folders
        for path in folder.rglob("*")
        if path.is_file() and path.name[0] != "."
    ]


def test_a_new_shape_is_accepted_and_becomes_ready(service: Serving) -> None:
    answer = service.add({"krug.ply": coloured_triangle(1)}, wait=0)
    assert answer.status_code == 202
    shape = answer.json()
    assert answer.headers["location"] == f"/v1/shapes/{shape['id']}"
    assert shape["status"] == "queued"
    assert shape["mesh"] is None
    ready = service.settled(shape["id"])
    assert ready["status"] == "ready"
    assert ready["mesh"]["colour"] == "vertex"
    assert (ready["mesh"]["vertices"], ready["mesh"]["faces"]) == (4, 2)
    assert ready["error"] is None


def test_a_shape_that_failed_is_described_once_more_where_that_is_asked_for(service: Serving) -> None:
    failed = service.add({"crash.ply": coloured_triangle(9)}, wait=60).json()
    assert failed["error"]["code"] == "gave_up"
    answer = service.client.post(f"/v1/shapes/{failed['id']}/retry")
    assert (answer.status_code, answer.json()["status"], answer.json()["error"]) == (202, "queued", None)
    assert service.settled(failed["id"])["error"]["code"] == "gave_up"
    ready = service.add({"fine.ply": coloured_triangle(9, 1)}).json()
    problem(service.client.post(f"/v1/shapes/{ready['id']}/retry"), 409, "not_failed")
    problem(service.client.post("/v1/shapes/none/retry"), 404, "not_found")


def test_waiting_answers_with_the_ready_shape(service: Serving) -> None:
    answer = service.add({"krug.ply": coloured_triangle(2)})
    assert answer.status_code == 201
    assert answer.json()["status"] == "ready"


def test_the_same_content_is_known(service: Serving) -> None:
    first = service.add({"a.ply": coloured_triangle(3), "notes.txt": b"x"})
    again = service.add({"notes.txt": b"x", "a.ply": coloured_triangle(3)}, name="another name")
    assert (first.status_code, again.status_code) == (201, 200)
    assert again.json()["id"] == first.json()["id"]
    assert again.headers["location"] == first.headers["location"]


def test_waiting_for_what_is_known_waits_too(service: Serving) -> None:
    files = {"late.ply": coloured_triangle(33)}
    service.add(files, wait=0)
    again = service.add(files)
    assert (again.status_code, again.json()["status"]) == (200, "ready")


def test_twenty_equal_uploads_at_once_make_one_shape_with_one_set_of_files(idle: Serving) -> None:
    before = len(kept(idle))
    with ThreadPoolExecutor(20) as threads:
        answers = list(threads.map(lambda _: idle.add({"same.ply": coloured_triangle(4)}, wait=0), range(20)))
    assert sorted(answer.status_code for answer in answers) == [200] * 19 + [202]
    assert len({answer.json()["id"] for answer in answers}) == 1
    assert len(kept(idle)) == before + 1


def test_an_id_is_an_opaque_uuid_and_times_are_rfc3339_in_utc(service: Serving) -> None:
    shape = service.add({"a.ply": coloured_triangle(5)}).json()
    assert UUID(shape["id"])
    assert shape["created_at"].endswith("Z")
    assert shape["created_at"] <= shape["updated_at"]


def test_a_shape_is_named_after_its_mesh_unless_a_name_is_given(service: Serving) -> None:
    files = {"tex/a.png": b"", "mesh/amphora.v2.ply": coloured_triangle(6)}
    assert service.add(files).json()["name"] == "amphora.v2"
    named = service.add({"a.ply": coloured_triangle(7)}, name=" Krug ", metadata='{"room": 3}').json()
    assert (named["name"], named["metadata"]) == ("Krug", {"room": 3})


def test_a_zip_gives_its_own_name(service: Serving) -> None:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr("inside/other.ply", coloured_triangle(8))
    answer = service.add({"parcel.zip": buffer.getvalue()})
    assert answer.status_code == 201, answer.text
    assert answer.json()["name"] == "parcel"


def test_allow_untextured_makes_it_another_content(idle: Serving) -> None:
    files = {"a.ply": coloured_triangle(9)}
    assert idle.add(files, wait=0, allow_untextured="false").status_code == 202
    assert idle.add(files, wait=0, allow_untextured="true").status_code == 202
    assert idle.add(files, wait=0).status_code == 200


@pytest.mark.parametrize(
    ("files", "code"),
    [
        ({"a.txt": b"x"}, "no_mesh"),
        ({"a.ply": b"ply", "b.obj": b"v 0 0 0"}, "several_meshes"),
        ({"../a.ply": b"ply"}, "unsafe_reference"),
        ({"a.zip": b"no zip"}, "bad_archive"),
        ({}, "no_files"),
    ],
)
def test_what_is_wrong_at_first_sight_is_refused_and_leaves_no_file(
    idle: Serving, files: dict[str, bytes], code: str
) -> None:
    before = kept(idle)
    answer = idle.add(files) if files else idle.client.post("/v1/shapes", files={"name": (None, b"x")})
    problem(answer, 422, code)
    assert kept(idle) == before


def test_a_missing_texture_fails_with_its_name_unless_it_may_be_missing(service: Serving) -> None:
    refused = service.add({"a.obj": OBJ})
    if refused.status_code == 422:
        detail = problem(refused, 422, "missing_texture")
    else:
        failed = service.settled(refused.json()["id"])
        assert (failed["status"], failed["error"]["code"]) == ("failed", "missing_texture")
        detail = failed["error"]["detail"]
    assert "m.mtl" in detail
    assert service.add({"a.obj": OBJ}, allow_untextured="true").status_code == 201


def test_what_only_the_worker_finds_turns_the_shape_to_failed_and_sending_it_again_tries_again(
    service: Serving,
) -> None:
    broken = coloured_triangle(10).replace(b"3 0 1 3", b"3 0 1 9")
    first = service.settled(service.add({"a.ply": broken}, wait=0).json()["id"])
    assert (first["status"], first["error"]["code"]) == ("failed", "index_out_of_range")
    again = service.add({"a.ply": broken})
    assert again.status_code == 202
    assert again.json()["id"] == first["id"]
    files = [file for file in kept(service) if "uploads" in file]
    assert len(files) == len(service.library.catalogue.file_keys())


@pytest.mark.parametrize(
    ("fields", "status", "code"),
    [
        ({"metadata": "[1]"}, 422, "bad_metadata"),
        ({"metadata": '{"a": NaN}'}, 422, "bad_metadata"),
        ({"metadata": '{"a": "' + "x" * 70_000 + '"}'}, 413, "field_too_long"),
        ({"name": "a\nb"}, 422, "bad_field"),
        ({"allow_untextured": "perhaps"}, 422, "bad_field"),
        ({"nmae": "typo"}, 422, "bad_field"),
    ],
)
def test_bad_fields_are_refused(idle: Serving, fields: dict[str, str], status: int, code: str) -> None:
    problem(idle.add({"a.ply": coloured_triangle()}, 0, **fields), status, code)


def test_bodies_that_are_no_form_or_too_large_are_refused(idle: Serving) -> None:
    problem(idle.client.post("/v1/shapes", json={}), 415, "not_multipart")
    problem(idle.client.post("/v1/shapes"), 415, "not_multipart")
    before = kept(idle)
    problem(idle.add({"a.ply": bytes(200_000)}), 413, "body_too_large")
    header = {"content-type": "multipart/form-data; boundary=b0"}
    start = b'--b0\r\nContent-Disposition: form-data; name="files"; filename="a.ply"\r\n\r\n'
    pieces = iter([start, *[bytes(50_000)] * 3])  # sent in chunks, without announcing a length
    problem(idle.client.post("/v1/shapes", content=pieces, headers=header), 413, "body_too_large")
    assert kept(idle) == before


def test_a_list_is_paged_newest_first_and_filtered(idle: Serving) -> None:
    ids = [
        idle.add(
            {"a.ply": coloured_triangle(50, number)}, wait=0, name=f"vase {number}", metadata='{"k": "Delft"}'
        )
        for number in range(5)
    ]
    expected = [answer.json()["id"] for answer in reversed(ids)]
    found, cursor = [], None
    while True:
        query = {"limit": "2", "q": "delft"} | ({"cursor": cursor} if cursor else {})
        page = idle.client.get("/v1/shapes", params=query).json()
        found += [shape["id"] for shape in page["items"]]
        cursor = page["next_cursor"]
        if cursor is None:
            break
    assert found == expected
    assert idle.client.get("/v1/shapes", params={"q": "vase 3"}).json()["items"][0]["name"] == "vase 3"
    assert idle.client.get("/v1/shapes", params={"status": "ready"}).json() == {
        "items": [],
        "next_cursor": None,
    }


@pytest.mark.parametrize(
    ("query", "code"),
    [
        ("limit=0", "invalid_request"),
        ("limit=x", "invalid_request"),
        ("status=lost", "invalid_request"),
        ("cursor=%00", "bad_cursor"),
        ("cursor=zzz", "bad_cursor"),
    ],
)
def test_bad_questions_for_a_list_are_refused(idle: Serving, query: str, code: str) -> None:
    problem(idle.client.get(f"/v1/shapes?{query}"), 422, code)


def test_name_and_metadata_can_be_changed_each_alone(idle: Serving) -> None:
    path = idle.add({"a.ply": coloured_triangle(60)}, wait=0, metadata='{"a": 1}').headers["location"]
    assert idle.client.patch(path, json={"name": " new "}).json()["name"] == "new"
    changed = idle.client.patch(path, json={"metadata": {"b": [1, "ü"]}}).json()
    assert (changed["name"], changed["metadata"]) == ("new", {"b": [1, "ü"]})
    assert idle.client.get(path).json() == changed


@pytest.mark.parametrize(
    ("body", "status", "code"),
    [
        ('{"name": ""}', 422, "bad_field"),
        ('{"metadata": [1]}', 422, "invalid_request"),
        ('{"nmae": "x"}', 422, "invalid_request"),
        ('{"metadata": {"a": "\\ud800"}}', 422, "bad_metadata"),
        ('{"metadata": {"a": "\\u0000"}}', 422, "bad_metadata"),
        ("{", 422, "invalid_request"),
        (json.dumps({"metadata": {"a": "x" * 2_000_000}}), 413, "body_too_large"),
    ],
)
def test_bad_changes_are_refused(idle: Serving, body: str, status: int, code: str) -> None:
    path = idle.add({"a.ply": coloured_triangle(61)}, wait=0).headers["location"]
    before = idle.client.get(path).json()
    answer = idle.client.patch(path, content=body, headers={"content-type": "application/json"})
    problem(answer, status, code)
    assert idle.client.get(path).json() == before


def test_removing_a_shape_removes_its_files_too(service: Serving) -> None:
    before = kept(service)
    path = service.add({"a.ply": coloured_triangle(70), "n.txt": b"n"}).headers["location"]
    assert len(kept(service)) == len(before) + 5  # two files, thumbnail, preview, signatures
    assert service.client.delete(path).status_code == 204
    assert kept(service) == before
    problem(service.client.get(path), 404, "not_found")
    problem(service.client.delete(path), 404, "not_found")
    problem(service.client.patch(path, json={}), 404, "not_found")


def test_unknown_paths_and_methods_are_problems_too(idle: Serving) -> None:
    problem(idle.client.get("/nothing"), 404, "not_found")
    refused = idle.client.put("/v1/shapes")
    problem(refused, 405, "method_not_allowed")
    assert "POST" in refused.headers["allow"] or "GET" in refused.headers["allow"]


def test_a_restarted_service_finds_everything(tmp_path: Path) -> None:
    with serving(settings_for(tmp_path)) as running:
        path = running.add({"a.ply": coloured_triangle(80)}).headers["location"]
        other = running.add({"b.ply": coloured_triangle(81)}).json()["id"]
        before = running.client.get(path).json()
    with serving(settings_for(tmp_path)) as running:
        assert running.client.get(path).json() == before
        assert running.client.get(f"{path}/files/a.ply").content == coloured_triangle(80)
        results = running.client.get(f"{path}/similar").json()["results"]
        assert [hit["shape"]["id"] for hit in results] == [other]
