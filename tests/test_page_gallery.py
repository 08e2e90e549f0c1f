"""The gallery: every shape once, as far as one scrolls, and as it was when one comes back."""

from collections.abc import Iterator
from itertools import count
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, Route, expect

from tests.accessible import assert_accessible
from tests.browsing import PHONE, opened
from tests.fakes import coloured_triangle
from tests.serving import Serving, serving, settings_for

SHAPES = 150
ICON = Path(__file__).parents[1] / "service" / "static" / "icon.svg"
HOSTILE = "<img src=x onerror=alert(1)> خزف " + "long" * 100

BACK = "\u2039 Library"  # a single angle quotation mark points back


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    """Serve shapes that wait: what is tested here needs no descriptions."""
    with serving(settings_for(tmp_path_factory.mktemp("library"), workers=0)) as running:
        for number in range(SHAPES):
            name = HOSTILE if number == SHAPES - 1 else f"shape {number:03}"
            running.add({"a.ply": coloured_triangle(number)}, wait=0, name=name)
        yield running


def _open(page: Page, service: Serving, address: str = "") -> None:
    page.goto(f"{service.client.base_url}{address}")
    expect(page.locator(".card").first).to_be_visible()


def _names(page: Page) -> list[str]:
    names: list[str] = page.locator(".card .name").evaluate_all("all => all.map(one => one.textContent)")
    return names


def _ready(service: Serving) -> list[dict[str, Any]]:
    """Return shapes as if they were described."""
    items = service.client.get("/v1/shapes", params={"limit": 20}).json()["items"]
    return [{**shape, "status": "ready", "mesh": {"faces": 2}} for shape in items]


def _scroll_to_the_end(page: Page) -> None:
    for _ in range(20):
        page.evaluate("scrollTo(0, document.body.scrollHeight)")
        if page.get_by_text(f"These are all {SHAPES} shapes").is_visible():
            return
        page.wait_for_timeout(200)


def test_scrolling_shows_every_shape_once_and_stops(service: Serving, browser: Browser) -> None:
    with opened(browser) as page:
        _open(page, service)
        assert len(_names(page)) < SHAPES
        _scroll_to_the_end(page)
        assert sorted(_names(page)) == sorted(
            [HOSTILE, *(f"shape {number:03}" for number in range(SHAPES - 1))]
        )
        expect(page.get_by_role("button", name="Show more")).to_have_count(0)


def test_more_is_shown_by_a_button_and_the_keyboard_goes_on_there(service: Serving, browser: Browser) -> None:
    with opened(browser) as page:
        page.add_init_script("IntersectionObserver.prototype.observe = () => {}")
        _open(page, service)
        assert len(_names(page)) == 60
        page.get_by_role("button", name="Show more").focus()
        page.keyboard.press("Enter")
        expect(page.locator(".card")).to_have_count(120)
        focused = page.evaluate("document.activeElement.querySelector('.name').textContent")
        assert focused == _names(page)[60]


def test_a_browser_that_tells_late_that_the_end_is_near_is_heard(service: Serving, browser: Browser) -> None:
    """Busy, it tells in one go where the end was and where it is now."""
    late = """window.IntersectionObserver = class {
        constructor(hear) { this.hear = hear; }
        observe() { setTimeout(() => this.hear([{ isIntersecting: false }, { isIntersecting: true }])); }
        disconnect() {}
    };"""
    with opened(browser) as page:
        page.add_init_script(late)
        _open(page, service)
        expect(page.get_by_text(f"These are all {SHAPES} shapes")).to_be_visible()


def test_a_page_that_failed_is_tried_again(service: Serving, browser: Browser) -> None:
    numbers = count()

    def failing_once(route: Route) -> None:
        if "cursor" in route.request.url and next(numbers) == 0:
            route.fulfill(status=503, json={"code": "busy", "detail": "The library is busy."})
        else:
            route.continue_()

    with opened(browser, expected=("503",)) as page:
        page.route("**/v1/shapes?*", failing_once)
        _open(page, service)
        page.evaluate("scrollTo(0, document.body.scrollHeight)")
        expect(page.get_by_role("alert")).to_contain_text("The library is busy.")
        page.get_by_role("button", name="Try again").click()
        _scroll_to_the_end(page)
        assert len(set(_names(page))) == len(_names(page)) == SHAPES


def test_who_comes_back_finds_the_library_as_it_was(service: Serving, browser: Browser) -> None:
    with opened(browser) as page:
        _open(page, service)
        _scroll_to_the_end(page)
        card = page.get_by_role("link", name="shape 040")
        # in the middle, clear of the header: a click scrolls no further
        card.evaluate("one => one.scrollIntoView({ block: 'center' })")
        before = page.evaluate("scrollY")
        card.click()
        expect(page.get_by_role("heading", level=1)).to_have_text("shape 040")
        page.go_back()
        expect(card).to_be_in_viewport()
        assert page.evaluate("scrollY") == before
        assert len(_names(page)) == SHAPES
        card.click()
        page.get_by_role("link", name=BACK).click()
        expect(card).to_be_in_viewport()


def test_what_is_far_off_is_not_drawn(service: Serving, browser: Browser) -> None:
    with opened(browser) as page:
        _open(page, service)
        heights = page.locator(".card").evaluate_all("all => all.map(one => one.offsetHeight)")
        assert len(set(heights)) == 1  # so that skipping what is far off moves nothing
        assert page.locator(".card").last.evaluate("one => getComputedStyle(one).contentVisibility") == "auto"


def test_a_hostile_name_is_only_text(service: Serving, browser: Browser) -> None:
    with opened(browser) as page:
        _open(page, service)
        expect(page.locator(".card .name").first).to_have_text(HOSTILE)
        assert page.locator("img[src=x]").count() == 0
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")


@pytest.mark.parametrize("phone", [False, True], ids=["desk", "phone"])
def test_the_gallery_is_accessible(service: Serving, browser: Browser, phone: bool) -> None:
    context = opened(browser, PHONE, touch=True) if phone else opened(browser)
    with context as page:
        _open(page, service, "/#/?q=shape")
        expect(page.locator(".title")).to_contain_text("149 of 150 shapes match")
        assert_accessible(page)
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")


@pytest.mark.parametrize("ratio", [1, 2])
@pytest.mark.parametrize("width", [390, 1280])
def test_no_thumbnail_is_wider_than_it_needs(
    service: Serving, browser: Browser, width: int, ratio: int
) -> None:
    """The width that is asked for is the smallest of those on offer that fills the place, or the largest."""
    context = browser.new_context(viewport={"width": width, "height": 800}, device_scale_factor=ratio)
    page = context.new_page()
    page.route("**/thumbnail.png*", lambda route: route.fulfill(path=ICON))
    page.route(
        "**/v1/shapes?*", lambda route: route.fulfill(json={"items": _ready(service), "next_cursor": None})
    )
    _open(page, service)
    pictures = page.locator(".card img")
    expect(pictures.first).to_have_js_property("complete", True)
    shown = pictures.evaluate_all(
        "all => all.slice(0, 8).map(one => [one.currentSrc, Math.min(one.clientWidth, one.clientHeight)])"
    )
    context.close()
    for address, place in shown:
        asked = int(address.rpartition("=")[2])
        enough = [one for one in (96, 160, 256) if one >= place * ratio]
        assert asked == (enough[0] if enough else 256), (address, place)
