"""Filters live in the address, and never take the words out of somebody's hands."""

import re
from collections.abc import Iterator
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.browsing import opened
from tests.fakes import coloured_triangle
from tests.serving import Serving, serving, settings_for

NAMES = ("red amphora", "black amphora", "red lekythos")

BACK = "\u2039 Library"  # a single angle quotation mark points back


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    with serving(settings_for(tmp_path_factory.mktemp("library"), workers=0)) as running:
        for number, name in enumerate(NAMES):
            metadata = f'{{"tags": ["{name.split()[0]}", "vase"], "room": "R{number}"}}'
            running.add({"a.ply": coloured_triangle(number)}, wait=0, name=name, metadata=metadata)
        yield running


def _open(page: Page, service: Serving, address: str = "") -> None:
    page.goto(f"{service.client.base_url}{address}")
    expect(page.get_by_role("search")).to_be_visible()


def _expect_names(page: Page, *names: str) -> None:
    expect(page.locator(".card .name")).to_have_text(list(names))


def test_words_filter_while_they_are_typed(service: Serving, browser: Browser) -> None:
    with opened(browser) as page:
        _open(page, service)
        field = page.get_by_role("searchbox")
        field.press_sequentially("AMPHOR", delay=20)
        _expect_names(page, "black amphora", "red amphora")
        expect(field).to_be_focused()
        expect(field).to_have_value("AMPHOR")
        expect(page).to_have_url(re.compile(r"#/\?q=AMPHOR$"))
        expect(page.locator(".title")).to_contain_text("2 of 3 shapes match")
        field.press_sequentially("A", delay=20)
        expect(page).to_have_url(re.compile(r"#/\?q=AMPHORA$"))
        page.go_back()  # one step for the whole word
        _expect_names(page, "red lekythos", "black amphora", "red amphora")
        expect(page.get_by_role("searchbox")).to_have_value("")


def test_metadata_are_searched_too(service: Serving, browser: Browser) -> None:
    with opened(browser) as page:
        _open(page, service)
        page.get_by_role("searchbox").fill("r1")
        _expect_names(page, "black amphora")


def test_tags_narrow_the_view_and_go_back(service: Serving, browser: Browser) -> None:
    with opened(browser) as page:
        _open(page, service)
        page.get_by_role("button", name="red 2").click()
        _expect_names(page, "red lekythos", "red amphora")
        page.get_by_role("button", name="vase 3").click()
        expect(page).to_have_url(re.compile(r"#/\?tag=red&tag=vase$"))
        page.get_by_role("searchbox").fill("lek")
        _expect_names(page, "red lekythos")
        expect(page).to_have_url(re.compile(r"#/\?q=lek&tag=red&tag=vase$"))
        page.go_back()
        _expect_names(page, "red lekythos", "red amphora")
        expect(page.get_by_role("button", name="vase 3")).to_have_attribute("aria-pressed", "true")
        page.get_by_role("button", name="vase 3").click()
        expect(page).to_have_url(re.compile(r"#/\?tag=red$"))


def test_an_address_with_filters_can_be_reloaded_and_shared(service: Serving, browser: Browser) -> None:
    with opened(browser) as page:
        _open(page, service, "/#/?q=red&tag=vase&status=queued")
        _expect_names(page, "red lekythos", "red amphora")
        expect(page.get_by_role("searchbox")).to_have_value("red")
        expect(page.get_by_label("State")).to_have_value("queued")
        page.reload()
        _expect_names(page, "red lekythos", "red amphora")


def test_a_state_is_chosen_with_its_number(service: Serving, browser: Browser) -> None:
    with opened(browser) as page:
        _open(page, service)
        states = page.get_by_label("State")
        expect(states.get_by_role("option", name="waiting (3)")).to_have_count(1)
        states.select_option("failed (0)")
        expect(page.get_by_role("heading", name="No shape matches")).to_be_visible()
        expect(page.get_by_text("the state “failed”")).to_be_visible()


def test_filters_that_nothing_passes_are_cleared_by_one_button(service: Serving, browser: Browser) -> None:
    with opened(browser) as page:
        _open(page, service)
        page.get_by_role("searchbox").fill("krater")
        expect(page.locator(".title")).to_contain_text("None of 3 shapes matches")
        page.get_by_role("button", name="Clear the filters").click()
        _expect_names(page, "red lekythos", "black amphora", "red amphora")
        expect(page.get_by_role("searchbox")).to_have_value("")
        expect(page).to_have_url(re.compile(r"#/$"))


def test_the_way_back_from_a_shape_keeps_the_filters(service: Serving, browser: Browser) -> None:
    with opened(browser) as page:
        _open(page, service, "/#/?tag=red")
        page.get_by_role("link", name="red amphora").click()
        page.get_by_role("link", name=BACK).click()
        expect(page).to_have_url(re.compile(r"#/\?tag=red$"))
        _expect_names(page, "red lekythos", "red amphora")


def test_the_page_judges_filters_as_the_service_does(service: Serving, browser: Browser) -> None:
    filters = [
        {"q": words, "tags": tags, "status": status}
        for words in ("", "AMPHORA\nRED", "d l", "R2", "tags")
        for tags in ([], ["RED"], ["red", "vase"])
        for status in ("", "queued", "ready")
    ]
    shapes = service.client.get("/v1/shapes").json()["items"]
    with opened(browser) as page:
        _open(page, service)
        passed = page.evaluate(
            """async ({shapes, filters}) => {
                const {passes} = await import("/static/gallery/filters.js");
                const named = (one) => shapes.filter((shape) => passes(shape, one)).map(({name}) => name);
                return filters.map(named);
            }""",
            {"shapes": shapes, "filters": filters},
        )
    for asked, names in zip(filters, passed, strict=True):
        assert names == _listed(service, asked), asked


def _listed(service: Serving, asked: dict[str, Any]) -> list[str]:
    parameters = {"q": asked["q"], "tag": asked["tags"]}
    status = {"status": asked["status"]} if asked["status"] else {}
    found = service.client.get("/v1/shapes", params=parameters | status).json()["items"]
    return [shape["name"] for shape in found]
