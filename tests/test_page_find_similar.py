"""A file is compared with the library without being added."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, Route, expect

from service.jobs.describing import describe_files
from tests.accessible import assert_accessible
from tests.browsing import opened
from tests.dragging import Drag, write
from tests.pages_of_uploads import REFUSED, choose, row, textured, vase
from tests.serving import Serving, serving, settings_for
from tests.small_library import good_mesh, open_small_library


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    settings = settings_for(tmp_path_factory.mktemp("library"))
    with serving(settings, describe=describe_files, open_library=open_small_library) as running:
        running.add(good_mesh(0), name="amphora")
        yield running


def answered(page: Page, service: Serving, query_id: str | None) -> None:
    """Answer the questions of a page as if they were kept under an id, or could not be kept."""
    found = service.client.post("/v1/search", files={"files": ("a.ply", good_mesh(1)["good.ply"])}).json()
    found["query"]["id"] = query_id
    page.route("**/v1/search?*", lambda route: route.fulfill(status=200, body=json.dumps(found)))


def test_an_answer_opens_as_a_page_of_its_own(service: Serving, browser: Browser, tmp_path: Path) -> None:
    files = write(tmp_path, {"shard.ply": good_mesh(1)["good.ply"]})
    with opened(browser, expected=("status of 404",)) as page:
        page.goto(str(service.client.base_url))
        answered(page, service, "q1")
        Drag(page, files / "shard.ply").drop_to_find()
        page.wait_for_url("**/#/queries/q1")
        expect(row(page, "shard").get_by_role("link", name="See what is similar")).to_be_visible()
    assert service.client.get("/v1/shapes").json()["items"][0]["name"] == "amphora"  # nothing was added


def test_an_answer_takes_nobody_away_who_went_elsewhere(
    service: Serving, browser: Browser, tmp_path: Path
) -> None:
    files = write(tmp_path, {"shard.ply": good_mesh(2)["good.ply"]})
    with opened(browser) as page:
        page.goto(str(service.client.base_url))
        held: list[Route] = []
        page.route("**/v1/search?*", lambda route: held.append(route))
        Drag(page, files / "shard.ply").drop_to_find()
        expect(row(page, "shard")).to_contain_text("sending")
        page.evaluate("location.hash = '#/?q=amphora'")
        answer = {"results": [], "query": {"id": "q2"}}
        held[0].fulfill(status=200, body=json.dumps(answer))
        link = row(page, "shard").get_by_role("link", name="See what is similar")
        expect(link).to_have_attribute("href", "#/queries/q2")
        assert page.url.endswith("#/?q=amphora")


def test_an_answer_that_cannot_be_kept_is_told_in_the_row(
    service: Serving, browser: Browser, tmp_path: Path
) -> None:
    files = write(tmp_path, {"shard.ply": good_mesh(3)["good.ply"]})
    with opened(browser) as page:
        page.goto(str(service.client.base_url))
        answered(page, service, None)
        choose(page, page.get_by_role("button", name="Find similar to a file"), str(files / "shard.ply"))
        expect(row(page, "shard")).to_contain_text("could not keep the question")
        expect(row(page, "shard").get_by_role("listitem").get_by_role("link")).to_have_text(["amphora"])
        assert_accessible(page)


def test_one_of_several_meshes_is_chosen(service: Serving, browser: Browser, tmp_path: Path) -> None:
    files = write(tmp_path, {f"finds/{name}.ply": good_mesh(n)["good.ply"] for n, name in enumerate("abc")})
    with opened(browser, expected=("status of 404",)) as page:
        page.goto(str(service.client.base_url))
        answered(page, service, "q3")
        Drag(page, files / "finds").drop_to_find()
        dialog = page.get_by_role("dialog", name="Which one shall be compared with the library?")
        assert_accessible(page)
        dialog.get_by_role("button", name="finds/b.ply").click()
        page.wait_for_url("**/#/queries/q3")
        expect(row(page, "b")).to_be_visible()
        Drag(page, files / "finds").drop_to_find()
        page.keyboard.press("Escape")  # none of them
        expect(dialog).to_have_count(0)
        expect(page.locator(".upload")).to_have_count(1)


def test_a_question_is_refused_and_mended_as_an_addition_is(
    service: Serving, browser: Browser, tmp_path: Path
) -> None:
    files = write(tmp_path, {**vase(2.5), "bare.obj": textured(2.6)})
    with opened(browser, expected=(REFUSED, "status of 404")) as page:
        page.goto(str(service.client.base_url))
        Drag(page, files / "vase.obj", files / "vase.mtl", files / "bare.obj").drop_to_find()
        page.get_by_role("button", name="vase.obj").click()
        Drag(page, files / "bare.obj").drop_to_find()
        expect(page.get_by_role("button", name="0 of 2 compared, 2 refused")).to_be_visible()
        answered(page, service, "q4")
        choose(
            page,
            row(page, "vase").get_by_role("button", name="Add the missing file"),
            str(files / "clay.png"),
        )
        page.wait_for_url("**/#/queries/q4")
        row(page, "bare").get_by_role("button", name="Compare without its texture").click()
        expect(page.get_by_role("button", name="2 of 2 compared")).to_be_visible()
