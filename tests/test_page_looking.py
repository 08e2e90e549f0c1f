"""Looking through a library for duplicates: page after page, with how far it is, until somebody stops it."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, Route, expect

from index.keys import Keys
from index.scopes import Scope
from service.jobs.describing import describe_files
from tests.browsing import opened
from tests.copies import add_copies
from tests.serving import Serving, serving, settings_for, wait_until
from tests.small_library import open_small_library


@pytest.fixture
def service(tmp_path: Path) -> Iterator[Serving]:
    with serving(settings_for(tmp_path), describe=describe_files, open_library=open_small_library) as running:
        add_copies(running, 0, "amphora", "copy")
        yield running


class Pages:
    """Pages of a large library: none has a group, until the real ones come; ``held`` are not answered."""

    def __init__(self, page: Page, empty: int) -> None:
        self.asked: list[str] = []
        self.empty = empty
        page.route("**/v1/counts", lambda route: route.fulfill(json={"ready": 1000}))
        page.route("**/v1/duplicates?**", self._answer)

    def _answer(self, route: Route) -> None:
        self.asked.append(route.request.url)
        number = len(self.asked)
        if number <= self.empty:
            route.fulfill(json={"items": [], "looked": 50, "next_cursor": f"page {number}"})
        elif number == self.empty + 1:
            real: dict[str, Any] = route.fetch(url=route.request.url.partition("&cursor")[0]).json()
            route.fulfill(json=real | {"looked": 50, "next_cursor": "more"})
        # what comes after is never answered


def test_it_goes_on_by_itself_until_a_group_is_found(service: Serving, browser: Browser) -> None:
    with opened(browser) as page:
        pages = Pages(page, empty=3)
        page.goto(f"{service.client.base_url}#/duplicates")
        expect(page.get_by_role("article")).to_be_visible()
        expect(page.locator(".looking")).to_contain_text("Looked at 200 of 1,000 shapes.")
        assert len(pages.asked) == 4
        assert "cursor=page+3" in pages.asked[-1]


def test_a_look_can_be_stopped_and_gone_on_with(service: Serving, browser: Browser) -> None:
    with opened(browser) as page:
        pages = Pages(page, empty=1)
        page.goto(f"{service.client.base_url}#/duplicates")
        page.get_by_role("button", name="Look further").click()
        expect(page.get_by_text("Looking: 100 of 1,000 shapes so far…")).to_be_visible()
        assert page.get_by_role("progressbar", name="Shapes looked at").get_attribute("value") == "100"
        page.get_by_role("button", name="Stop").click()
        expect(page.get_by_role("button", name="Look further")).to_be_visible()
        page.get_by_role("button", name="Look further").click()
        wait_until(lambda: page.evaluate("1") == 1 and len(pages.asked) == 4)
        assert "cursor=more" in pages.asked[-1]


def test_a_key_that_may_only_look_hears_why_it_may_not_dismiss(service: Serving, browser: Browser) -> None:
    secret = Keys(service.library.engine).create("reader", Scope.READ)[1]
    wait_until(lambda: service.client.get("/v1/methods").status_code == 401)
    with opened(browser, expected=("401", "403")) as page:
        page.goto(f"{service.client.base_url}#/duplicates")
        page.get_by_label("Key").fill(secret)
        page.get_by_role("button", name="Open").click()
        expect(page.locator(".copy img")).to_have_count(2)
        page.get_by_role("button", name="Not a duplicate").click()
        expect(page.get_by_role("alert")).to_contain_text("read_only_key")
        expect(page.get_by_role("article")).to_be_visible()
        assert page.get_by_role("button", name="Undo").count() == 0
