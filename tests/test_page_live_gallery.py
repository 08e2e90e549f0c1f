"""The gallery while the library changes: cards change in place, and nobody's place is lost."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page, expect

from service.jobs.describing import describe_files
from tests.browsing import opened
from tests.fakes import coloured_triangle
from tests.serving import Serving, serving, settings_for
from tests.small_library import good_mesh, open_small_library

FIRST = 30  # shapes that are there before
FLAT = {
    "flat.ply": coloured_triangle()
    .replace(b"1 0 0", b"0 0 0")
    .replace(b"0 1 0", b"0 0 0")
    .replace(b"0 0 1", b"0 0 0")
}


@pytest.fixture
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    settings = settings_for(tmp_path_factory.mktemp("library"))
    with serving(settings, describe=describe_files, open_library=open_small_library) as running:
        yield running


@pytest.fixture
def waiting(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    """Serve a library that fills some screens, without a worker."""
    with serving(settings_for(tmp_path_factory.mktemp("library"), workers=0)) as running:
        for number in range(FIRST):
            running.add({"a.ply": coloured_triangle(number)}, wait=0, name=f"shape {number:02}")
        yield running


def _open(page: Page, service: Serving, address: str = "") -> None:
    """Open the gallery; return when it hears of changes."""
    with page.expect_response("**/v1/events"):
        page.goto(f"{service.client.base_url}{address}")
    page.wait_for_timeout(300)  # it catches up with what it may have missed


def test_a_new_shape_appears_on_top_and_gets_its_picture(service: Serving, browser: Browser) -> None:
    service.add(good_mesh(0), name="amphora")
    with opened(browser) as page:
        _open(page, service)
        service.add(good_mesh(1), name="lekythos")
        expect(page.locator(".card .name")).to_have_text(["lekythos", "amphora"])
        picture = page.get_by_role("link", name="lekythos").locator("img")
        expect(picture).to_have_js_property("complete", True)
        expect(page.locator(".title")).to_contain_text("2 shapes")


def test_a_failed_shape_says_why_and_leads_to_its_details(service: Serving, browser: Browser) -> None:
    with opened(browser) as page:
        _open(page, service)
        refused = service.add(FLAT, name="flat").json()
        assert refused["error"]["code"] == "zero_area"
        card = page.get_by_role("link", name="flat")
        expect(card).to_contain_text(refused["error"]["detail"])
        expect(page.locator(".title")).to_contain_text("1 shape, 1 failed")
        card.click()
        expect(page.get_by_role("heading", name="Why it failed")).to_be_visible()


def test_new_shapes_announce_themselves_to_who_looks_at_others(waiting: Serving, browser: Browser) -> None:
    with opened(browser) as page:
        _open(page, waiting)
        page.evaluate("scrollTo(0, 600)")
        page.wait_for_function("() => scrollY === 600")
        seen = page.get_by_role("link", name="shape 02").bounding_box()
        for number in range(3):
            waiting.add({"a.ply": coloured_triangle(100 + number)}, wait=0, name=f"new {number}")
        button = page.get_by_role("button", name="3 new shapes")
        expect(button).to_be_visible()
        expect(page.get_by_role("link", name="new 0")).to_have_count(0)
        assert page.get_by_role("link", name="shape 02").bounding_box() == seen
        button.click()
        expect(page.locator(".card .name").first).to_have_text("new 2")
        expect(page.get_by_role("link", name="new 2")).to_be_in_viewport()
        expect(page.locator(".card")).to_have_count(FIRST + 3)


def test_a_shape_that_is_removed_elsewhere_goes(waiting: Serving, browser: Browser) -> None:
    gone = waiting.client.get("/v1/shapes").json()["items"][0]
    with opened(browser) as page:
        _open(page, waiting)
        expect(page.get_by_role("link", name=gone["name"])).to_be_visible()
        waiting.client.delete(f"/v1/shapes/{gone['id']}")
        expect(page.get_by_role("link", name=gone["name"])).to_have_count(0)
        expect(page.locator(".title")).to_contain_text(f"{FIRST - 1} shapes")


def test_filters_hold_for_what_changes(waiting: Serving, browser: Browser) -> None:
    shape = waiting.client.get("/v1/shapes", params={"q": "shape 05"}).json()["items"][0]
    with opened(browser) as page:
        _open(page, waiting, "/#/?q=amphora")
        expect(page.get_by_role("heading", name="No shape matches")).to_be_visible()
        waiting.client.patch(f"/v1/shapes/{shape['id']}", json={"name": "amphora"})
        expect(page.locator(".card .name")).to_have_text(["amphora"])
        waiting.client.patch(f"/v1/shapes/{shape['id']}", json={"name": "shape 05"})
        expect(page.locator(".card")).to_have_count(0)


def test_what_changed_while_another_page_was_shown_is_there_afterwards(
    waiting: Serving, browser: Browser
) -> None:
    shape = waiting.client.get("/v1/shapes", params={"q": "shape 29"}).json()["items"][0]
    with opened(browser) as page:
        _open(page, waiting)
        page.get_by_role("link", name="shape 28").click()
        expect(page.get_by_role("heading", level=1)).to_have_text("shape 28")
        waiting.client.patch(f"/v1/shapes/{shape['id']}", json={"name": "renamed"})
        page.wait_for_timeout(1500)  # the stream looks twice a second
        page.go_back()
        expect(page.locator(".card .name").first).to_have_text("renamed")
