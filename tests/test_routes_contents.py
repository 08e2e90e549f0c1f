"""What belongs to a shape comes back safely."""

from collections.abc import Iterator

import pytest

from tests.fakes import coloured_triangle
from tests.problems import problem
from tests.serving import Serving, serving, settings_for

pytestmark = pytest.mark.usefixtures("storage")  # with files in a folder and in a bucket


@pytest.fixture(scope="module")
def service(storage: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    with serving(settings_for(tmp_path_factory.mktemp("library"))) as running:
        yield running


@pytest.fixture(scope="module")
def path(service: Serving) -> str:
    files = {"a.ply": coloured_triangle(), "tex/Größe & <b>.png": b"<script>alert(1)</script>"}
    return service.add(files).headers["location"]


def test_files_come_back_byte_for_byte_under_their_names(service: Serving, path: str) -> None:
    listed = service.client.get(path).json()["files"]
    assert [file["name"] for file in listed] == ["a.ply", "tex/Größe & <b>.png"]
    assert service.client.get(f"{path}/files/a.ply").content == coloured_triangle()
    assert service.client.get(f"{path}/files/tex/Größe & <b>.png").content == b"<script>alert(1)</script>"


def test_browsers_are_told_to_save_files_never_to_show_them(service: Serving, path: str) -> None:
    headers = service.client.get(f"{path}/files/tex/Größe & <b>.png").headers
    assert headers["content-disposition"].startswith("attachment;")
    assert "tex" not in headers["content-disposition"]
    assert headers["content-type"] == "application/octet-stream"
    assert headers["x-content-type-options"] == "nosniff"
    assert "sandbox" in headers["content-security-policy"]


@pytest.mark.parametrize("name", ["b.ply", "..%2f..%2fcatalogue.sqlite3", "%00", "0"])
def test_a_file_that_was_not_uploaded_is_not_found(service: Serving, path: str, name: str) -> None:
    problem(service.client.get(f"{path}/files/{name}"), 404, "file_missing")


def test_pictures_come_with_their_types_and_can_be_asked_for_again_cheaply(
    service: Serving, path: str
) -> None:
    picture = service.client.get(f"{path}/thumbnail.png")
    assert (picture.headers["content-type"], picture.content[:4]) == ("image/png", b"\x89PNG")
    preview = service.client.get(f"{path}/preview.glb")
    assert (preview.headers["content-type"], preview.content[:4]) == ("model/gltf-binary", b"glTF")


def test_a_byte_range_that_is_not_there_is_a_problem(service: Serving, path: str) -> None:
    part = service.client.get(f"{path}/files/a.ply", headers={"range": "bytes=0-2"})
    assert (part.status_code, part.content) == (206, b"ply")
    beyond = service.client.get(f"{path}/files/a.ply", headers={"range": "bytes=99999-"})
    problem(beyond, 416, "range_not_satisfiable")


def test_the_numbers_say_what_they_belong_to(service: Serving, path: str) -> None:
    numbers = service.client.get(f"{path}/descriptors").json()
    vocabulary = service.library.catalogue.active_vocabulary()
    assert vocabulary is not None
    assert (numbers["vocabulary"], numbers["fingerprint"]) == (vocabulary.id, vocabulary.fingerprint)
    assert set(numbers["blocks"]) >= {"hks-0", "hks-0.05", "log-hks", "colour-histogram", "diffusion-joint"}
    assert sum(numbers["blocks"]["hks-0"]) == pytest.approx(1)
    assert numbers["eigenvalues"]["0"] == sorted(numbers["eigenvalues"]["0"])


def test_a_shape_that_failed_has_no_picture_and_no_numbers(service: Serving) -> None:
    broken = coloured_triangle().replace(b"3 0 1 3", b"3 0 1 9")
    path = service.add({"a.ply": broken}).headers["location"]
    problem(service.client.get(f"{path}/thumbnail.png"), 404, "file_missing")
    problem(service.client.get(f"{path}/preview.glb"), 404, "file_missing")
    problem(service.client.get(f"{path}/descriptors"), 409, "not_ready")


def test_nothing_of_a_shape_that_does_not_exist_is_found(service: Serving) -> None:
    for part in ("files/a.ply", "thumbnail.png", "preview.glb", "descriptors", "similar"):
        problem(service.client.get(f"/v1/shapes/unknown/{part}"), 404, "not_found")
