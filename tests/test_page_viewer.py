"""The 3D view: a query beside a result, both turned by one hand."""

import io
from collections.abc import Iterator

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, Page, Route, expect

from tests.accessible import assert_accessible
from tests.answering import answer_of, blocks_served
from tests.browsing import DESK, PHONE
from tests.serving import Serving
from worker.arrays import ByteArray

NO_WEBGL = """
  const context = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
    return kind.startsWith("webgl") ? null : context.call(this, kind, ...more);
  };"""

HOLDING = """
  const context = HTMLCanvasElement.prototype.getContext;
  window.held = []; // so that none is swept away by itself
  HTMLCanvasElement.prototype.getContext = function (...wanted) {
    const given = context.apply(this, wanted);
    held.push(given);
    return given;
  };"""


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Serving, str]]:
    with blocks_served(tmp_path_factory.mktemp("library")) as served:
        yield served


def compare(page: Page, name: str = "blue cube") -> None:
    """Open the view with a result and wait for its models."""
    page.get_by_role("button", name=f"{name}: compare in 3D").click()
    shown(page)


def shown(page: Page) -> None:
    """Wait until models have taken their places, and are painted."""
    expect(page.locator(".viewer .place.taken").first).to_be_visible()
    page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def pixels(page: Page, place: int) -> ByteArray:
    """Return what a place of the view shows, (rows, columns, 3)."""
    picture = page.locator(".viewer .place").nth(place).screenshot()
    return np.asarray(Image.open(io.BytesIO(picture)).convert("RGB"))


def colourful(picture: ByteArray) -> float:
    """Return the share of pixels that are no grey."""
    return float(np.mean(np.ptp(picture.astype(int), axis=2) > 60))


def test_both_are_seen_in_their_colours(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}", browser) as page:
        compare(page)
        red, blue = pixels(page, 0), pixels(page, 1)
        assert min(colourful(red), colourful(blue)) > 0.05
        left, right = (half[np.ptp(half.astype(int), axis=2) > 60].mean(0) for half in (red, blue))
        assert left[0] > 2 * left[2]
        assert right[2] > 2 * right[0]


def test_it_looks_like_the_thumbnail(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library
    thumbnail = service.client.get(f"/v1/shapes/{query}/thumbnail.png").content
    seen = np.asarray(Image.open(io.BytesIO(thumbnail)))
    expected = seen[seen[..., 3] == 255][:, :3].mean(0)
    with answer_of(service, f"/#/shapes/{query}", browser) as page:
        compare(page)
        model = pixels(page, 0)
        assert (
            np.abs(model[np.ptp(model.astype(int), axis=2) > 60].mean(0) - expected).max() < 20
        )  # its light is for flat walls


def test_one_hand_turns_both(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}", browser) as page:
        compare(page)
        for act in ("ArrowLeft", "+", "drag", "wheel"):
            before = [pixels(page, 0), pixels(page, 1)]
            _act(page, act)
            page.wait_for_timeout(100)
            for place in (0, 1):
                assert np.any(pixels(page, place) != before[place]), f"{act} {place}"


def _act(page: Page, act: str) -> None:
    box = page.locator(".viewer canvas").bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 150, box["y"] + 200)
    if act == "drag":
        page.mouse.down()
        page.mouse.move(box["x"] + 210, box["y"] + 220, steps=3)
        page.mouse.up()
    elif act == "wheel":
        page.mouse.wheel(0, -300)
    else:
        page.keyboard.press(act)


def test_results_follow_each_other_by_keys_and_buttons(
    library: tuple[Serving, str], browser: Browser
) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}", browser) as page:
        names = [
            result["shape"]["name"]
            for result in service.client.get(f"/v1/shapes/{query}/similar").json()["results"]
        ]
        expect(page.locator(".result")).to_have_count(3)
        compare(page, names[0])
        caption = page.locator(".viewer figcaption strong").last
        expect(page.get_by_role("button", name="Previous result")).to_be_disabled()
        page.keyboard.press("PageDown")
        expect(caption).to_have_text(f"2. {names[1]}")
        page.get_by_role("button", name="Next result").click()
        expect(caption).to_have_text(f"3. {names[2]}")
        page.keyboard.press("PageDown")
        expect(caption).to_have_text(f"3. {names[2]}")
        page.keyboard.press("PageUp")
        expect(caption).to_have_text(f"2. {names[1]}")


def test_a_relation_that_comes_later_is_told_there_too(
    library: tuple[Serving, str], browser: Browser
) -> None:
    service, query = library
    held: list[Route] = []
    with answer_of(service, "/", browser) as page:
        page.route("**/similar?*relations=true*", lambda route: held.append(route))
        page.evaluate(f"location.hash = '#/shapes/{query}'")
        compare(page)
        expect(page.locator(".viewer .told")).not_to_contain_text("Recoloured")
        held[0].continue_()
        expect(page.locator(".viewer .told")).to_contain_text("Recoloured, since")


def test_escape_gives_the_focus_back(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}", browser) as page:
        opener = page.get_by_role("button", name="red tower: compare in 3D")
        opener.press("Enter")
        shown(page)
        page.keyboard.press("Escape")
        expect(page.get_by_role("dialog")).to_have_count(0)
        expect(opener).to_be_focused()


def test_leaving_the_page_closes_it(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}", browser) as page:
        compare(page)
        page.get_by_role("dialog").get_by_role("link", name="Similar to this").click()
        expect(page.get_by_role("heading", name="blue cube", level=1)).to_be_visible()
        expect(page.get_by_role("dialog")).to_have_count(0)


def test_three_is_loaded_when_it_is_first_needed(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library
    asked: list[str] = []
    with answer_of(service, "/", browser) as page:
        page.on("request", lambda request: asked.append(request.url))
        page.evaluate(f"location.hash = '#/shapes/{query}'")
        expect(page.locator(".result")).to_have_count(3)
        assert not any("three" in address for address in asked)
        page.get_by_role("button", name="Look at red cube in 3D").click()
        shown(page)
        assert sum("three" in address for address in asked) == 1
        expect(page.locator(".viewer .place")).to_have_count(1)
        assert colourful(pixels(page, 0)) > 0.02


def test_twenty_openings_leave_nothing_behind(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library  # browsers hold sixteen contexts, and warn of more; `opened` fails then
    with answer_of(service, "/", browser) as page:
        page.add_init_script(HOLDING)
        page.goto(f"{service.client.base_url}/#/shapes/{query}")
        page.reload()
        for _ in range(20):
            compare(page)
            page.get_by_role("button", name="Close").click()
            expect(page.locator(".viewer, canvas")).to_have_count(0)
        assert page.evaluate("held.map((context) => context.isContextLost())") == [True] * 20
        compare(page)
        assert colourful(pixels(page, 1)) > 0.05


def test_it_turns_by_itself_only_where_motion_is_welcome(
    library: tuple[Serving, str], browser: Browser
) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}", browser) as page:
        compare(page)
        turning = page.get_by_role("button", name="Turn")
        expect(turning).to_have_attribute("aria-pressed", "false")
        still = pixels(page, 0)
        page.wait_for_timeout(300)
        assert np.array_equal(pixels(page, 0), still)
        turning.click()
        page.wait_for_timeout(300)
        assert not np.array_equal(pixels(page, 0), still)
        page.keyboard.press("Escape")
        page.emulate_media(reduced_motion="no-preference")
        compare(page)
        expect(turning).to_have_attribute("aria-pressed", "true")
        _act(page, "drag")
        expect(turning).to_have_attribute("aria-pressed", "false")


def test_without_webgl_the_thumbnails_are_large_and_it_says_why(
    library: tuple[Serving, str], browser: Browser
) -> None:
    service, query = library
    with answer_of(service, "/", browser) as page:
        page.add_init_script(NO_WEBGL)
        page.goto(f"{service.client.base_url}/#/shapes/{query}")
        page.reload()
        page.get_by_role("button", name="blue cube: compare in 3D").click()
        expect(page.get_by_role("alert")).to_contain_text("This browser shows no 3D")
        for picture in page.locator(".viewer .place img").all():
            expect(picture).to_be_visible()
            box = picture.bounding_box()
            assert box is not None
            assert box["width"] > 200
        expect(page.locator(".viewer canvas")).to_be_hidden()
        assert_accessible(page)


@pytest.mark.parametrize("phone", [False, True])
def test_everybody_can_use_it(library: tuple[Serving, str], browser: Browser, phone: bool) -> None:
    service, query = library
    viewport = PHONE if phone else DESK
    with answer_of(service, f"/#/shapes/{query}", browser, viewport, touch=phone) as page:
        expect(page.locator(".relation button")).to_have_count(3)
        compare(page)
        assert_accessible(page)
        first, second = (place.bounding_box() for place in page.locator(".viewer .place").all())
        assert first is not None
        assert second is not None
        assert (second["y"] > first["y"] + first["height"] - 1) == phone  # one above the other
        assert first["x"] + first["width"] <= page.evaluate("innerWidth")
