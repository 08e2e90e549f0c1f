"""Explanations over HTTP."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from index.errors import VocabularyChanged
from index.methods import METHODS
from service.jobs.describing import describe_files
from service.why.scale import COLOURS
from service.why.sides import remembered_side, stored_side
from tests.painted import PLACED_METHODS
from tests.problems import problem
from tests.serving import Serving, serving, settings_for
from tests.small_library import good_mesh, open_small_library, small_vocabulary
from worker.pictures.preview_points import read_colours, read_points


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    settings = settings_for(tmp_path_factory.mktemp("library"), workers=1)
    with serving(settings, describe_files, open_small_library) as running:
        for number in (1, 2, 3):
            answer = running.add(good_mesh(number), name=f"block {number}")
            assert answer.status_code == 201, answer.text
        yield running


def ids(service: Serving) -> list[str]:
    return [shape["id"] for shape in service.client.get("/v1/shapes").json()["items"]]


@pytest.mark.parametrize("name", PLACED_METHODS)
def test_the_distance_is_that_of_a_search_with_the_same_weights(service: Serving, name: str) -> None:
    one, other, *_ = ids(service)
    weights = ",".join(f"{block.name}:{block.weight!r}" for block in METHODS[name].blocks)
    found = service.client.get(f"/v1/shapes/{one}/why/{other}", params={"method": name}).json()
    hits = service.client.get(
        f"/v1/shapes/{one}/similar", params={"method": name, "weights": weights}
    ).json()["results"]
    (searched,) = (hit["distance"] for hit in hits if hit["shape"]["id"] == other)
    assert found["method"] == name
    assert found["distance"] == pytest.approx(searched, rel=1e-5)
    assert sum(block["contribution"] for block in found["blocks"]) == pytest.approx(found["distance"])
    for block, own in zip(found["blocks"], METHODS[name].blocks, strict=True):
        assert (block["name"], block["looks_at"]) == (own.name, own.looks_at)
        assert block["contribution"] == pytest.approx(own.weight * block["distance"] ** own.power)
        assert 0 <= block["placed"] <= 1
    assert found["scale"] > 0


def test_both_meshes_are_those_of_the_previews_in_other_colours(service: Serving) -> None:
    one, other, *_ = ids(service)
    for shape_id, which in ((one, "query"), (other, "result")):
        answer = service.client.get(f"/v1/shapes/{one}/why/{other}/{which}.glb")
        assert answer.status_code == 200
        assert answer.headers["content-type"] == "model/gltf-binary"
        preview = service.client.get(f"/v1/shapes/{shape_id}/preview.glb").content
        for shown, known in zip(read_points(answer.content), read_points(preview), strict=True):
            np.testing.assert_array_equal(shown, known)
        assert np.abs(read_colours(answer.content) - read_colours(preview)).max() > 0.1


def test_a_shape_and_itself_are_grey_all_over(service: Serving) -> None:
    one = ids(service)[0]
    found = service.client.get(f"/v1/shapes/{one}/why/{one}").json()
    assert found["distance"] == 0
    colours = read_colours(service.client.get(f"/v1/shapes/{one}/why/{one}/query.glb").content)
    grey = [int(COLOURS[0][i : i + 2], 16) / 255 for i in (1, 3, 5)]
    np.testing.assert_allclose(colours, np.tile(grey, (len(colours), 1)), atol=0.005)


def test_own_weights_count_as_in_a_search(service: Serving) -> None:
    one, other, *_ = ids(service)
    path = f"/v1/shapes/{one}/why/{other}"
    shape = "log-hks:1,colour-histogram:0,colour-curves:0"
    found = service.client.get(path, params={"weights": shape}).json()
    assert [block["share"] for block in found["blocks"]] == [1, 0, 0]
    assert found["distance"] == pytest.approx(found["blocks"][0]["distance"])
    colour = "log-hks:0,colour-histogram:1,colour-curves:0"
    meshes = [service.client.get(f"{path}/query.glb", params={"weights": w}).content for w in (shape, colour)]
    assert not np.array_equal(read_colours(meshes[0]), read_colours(meshes[1]))


@pytest.mark.parametrize("end", ["", "/query.glb", "/result.glb"])
@pytest.mark.parametrize("name", ["fused", "chks"])
def test_a_mesh_that_is_not_kept_is_explained_as_one_that_is(service: Serving, name: str, end: str) -> None:
    known = {shape["name"]: shape["id"] for shape in service.client.get("/v1/shapes").json()["items"]}
    parts = [("files", each) for each in good_mesh(1).items()]
    query = service.client.post("/v1/search?remember=true", files=parts).json()["query"]["id"]
    asked, ending = {"method": name}, f"why/{known['block 2']}{end}"
    answer = service.client.get(f"/v1/queries/{query}/{ending}", params=asked)
    assert answer.status_code == 200, answer.text
    stored = service.client.get(f"/v1/shapes/{known['block 1']}/{ending}", params=asked)
    assert answer.content == stored.content


@pytest.mark.parametrize("end", ["", "/query.glb", "/result.glb"])
def test_a_query_that_is_forgotten_is_not_explained(service: Serving, end: str) -> None:
    path = f"/v1/queries/{'0' * 32}/why/{ids(service)[0]}{end}"
    problem(service.client.get(path), 404, "query_not_found")


def test_blocks_are_not_placed_by_the_words_of_another_vocabulary(service: Serving) -> None:
    query = service.client.post(
        "/v1/search?remember=true", files=[("files", each) for each in good_mesh(1).items()]
    ).json()["query"]["id"]
    another = replace(small_vocabulary(), fingerprint="another")
    with pytest.raises(VocabularyChanged):
        stored_side(service.library, ids(service)[0], ["log-hks"], another)
    with pytest.raises(VocabularyChanged):
        remembered_side(service.library, query, ["log-hks"], another)


@pytest.mark.parametrize("end", ["", "/query.glb", "/result.glb"])
def test_bad_questions_are_refused(service: Serving, end: str) -> None:
    one, other, *_ = ids(service)
    get = service.client.get
    path = f"/v1/shapes/{one}/why/{other}{end}"
    for name in ("diffusion", "colour-diffusion", "meshhog"):
        assert name in problem(get(path, params={"method": name}), 422, "not_explained")
    problem(get(path, params={"method": "nothing"}), 422, "unknown_method")
    problem(get(path, params={"weights": "hks-0:1"}), 422, "bad_weights")
    problem(get(path, params={"weights": "log-hks"}), 422, "bad_weights")
    problem(get(f"/v1/shapes/{one}/why/nobody{end}"), 404, "not_found")
    problem(get(f"/v1/shapes/nobody/why/{one}{end}"), 404, "not_found")


def test_a_shape_that_failed_is_not_explained(service: Serving) -> None:
    one = ids(service)[0]
    broken = service.add({"a.ply": good_mesh(1)["good.ply"].replace(b"4 0 2 3 1", b"4 0 2 3 99")}).json()[
        "id"
    ]
    problem(service.client.get(f"/v1/shapes/{one}/why/{broken}"), 409, "not_ready")
    problem(service.client.get(f"/v1/shapes/{broken}/why/{one}/query.glb"), 409, "not_ready")
