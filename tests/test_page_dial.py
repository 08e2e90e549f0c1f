"""The dial between geometry and colour, and the paper's methods."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page, Request, Route, expect

from tests.answering import answer_of, blocks_served, names
from tests.serving import Serving

WEIGH = "async ([asked, methods]) => (await import('/static/answer/dial.js')).parametersOf(asked, methods)"
METHODS = [
    {
        "name": "fused",
        "default": True,
        "blocks": [
            {"name": "shape", "weight": 2, "looks_at": "geometry"},
            {"name": "paint", "weight": 0.5, "looks_at": "colour"},
            {"name": "mixed", "weight": 1, "looks_at": "both"},
        ],
    }
]


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Serving, str]]:
    with blocks_served(tmp_path_factory.mktemp("library")) as served:
        yield served


def _turn(page: Page, colour: int) -> None:
    page.get_by_role("slider").fill(str(colour))


def test_geometry_finds_the_same_shape_and_colour_the_same_colours(
    library: tuple[Serving, str], browser: Browser
) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}", browser) as page:
        expect(page.locator(".result")).to_have_count(3)
        _turn(page, 0)
        expect(page.locator(".result .name").first).to_have_text("blue cube")
        expect(page.get_by_role("slider")).to_have_attribute("aria-valuetext", "Geometry alone")
        _turn(page, 100)
        expect(page.locator(".result .name").first).to_have_text("red tower")
        expect(page.get_by_text("The second, closer look is off")).to_be_visible()


@pytest.mark.parametrize(
    ("colour", "weights"),
    [(0, "shape:4,paint:0,mixed:0"), (75, "shape:1,paint:0.75,mixed:0.5"), (100, "shape:0,paint:1,mixed:0")],
)
def test_the_dial_weighs_the_blocks(
    library: tuple[Serving, str], browser: Browser, colour: int, weights: str
) -> None:
    with answer_of(library[0], "/", browser) as page:
        asked = {"method": "", "colour": colour}
        assert page.evaluate(WEIGH, [asked, METHODS]) == {"method": "fused", "weights": weights}


def test_the_middle_is_the_default_with_its_second_look(
    library: tuple[Serving, str], browser: Browser
) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}?colour=70", browser) as page:
        assert page.evaluate(WEIGH, [{"method": "", "colour": 50}, METHODS]) == {}
        page.get_by_role("button", name="Back to the middle").click()
        expect(page.get_by_role("slider")).to_be_focused()
        expect(page.get_by_text("looked at a second time")).to_be_visible()
        expect(page.locator(".relation button")).to_have_count(3)
        assert page.evaluate("location.hash") == f"#/shapes/{query}"


def test_by_keyboard_the_address_follows_and_a_reload_restores_it(
    library: tuple[Serving, str], browser: Browser
) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}", browser) as page:
        page.get_by_role("slider").focus()
        for _ in range(8):
            page.keyboard.press("ArrowRight")
        assert page.evaluate("location.hash") == f"#/shapes/{query}?colour=90"
        page.reload()
        expect(page.get_by_role("slider")).to_have_value("90")
        expect(page.get_by_role("slider")).to_have_attribute("aria-valuetext", "Mostly colour")
        expect(page.locator(".result .name").first).to_have_text("red tower")


def test_the_papers_methods_are_presets(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}", browser) as page:
        expect(page.locator(".result")).to_have_count(3)
        with page.expect_response(lambda answer: "method=chks" in answer.url) as answered:
            page.get_by_role("combobox", name="Method").select_option("The paper's main system (chks)")
        expected = [result["shape"]["name"] for result in answered.value.json()["results"]]
        expect(page.locator(".result .name")).to_have_text(expected)
        expect(page.get_by_text("Colour heat kernel signatures")).to_be_visible()
        page.reload()
        expect(page.get_by_role("combobox", name="Method")).to_have_value("chks")
        _turn(page, 0)
        expect(page.get_by_role("combobox", name="Method")).to_have_value("")


def test_a_method_that_nobody_knows_is_refused_in_words(
    library: tuple[Serving, str], browser: Browser
) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}?method=magic", browser, expected=("422", "404")) as page:
        expect(page.get_by_role("alert")).to_contain_text("no method is called 'magic'")
        page.get_by_role("button", name="Back to the middle").click()
        expect(page.locator(".result")).to_have_count(3)


def test_the_latest_place_of_the_dial_wins(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library
    held: list[Route] = []
    ended: list[Request] = []
    with answer_of(service, f"/#/shapes/{query}?colour=100", browser) as page:
        expect(page.locator(".result .name").first).to_have_text("red tower")
        page.on("requestfailed", lambda request: ended.append(request))
        page.route("**/similar?*colour-histogram%3A0.2*", lambda route: held.append(route))  # never answered
        _turn(page, 20)
        _turn(page, 0)
        expect(page.locator(".result .name").first).to_have_text("blue cube")
        assert len(held) == len(ended) == 1
        assert names(page)[0] == "blue cube"


def test_cards_glide_only_where_motion_is_welcome(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library
    moving = "[...document.querySelectorAll('.result')].filter((card) => card.getAnimations().length).length"
    watch = f"() => {{ window.seen = 0; setInterval(() => {{ seen = Math.max(seen, {moving}) }}, 5) }}"
    with answer_of(service, f"/#/shapes/{query}?colour=0", browser) as page:
        for motion, glided in (("reduce", False), ("no-preference", True)):
            page.emulate_media(reduced_motion=motion)  # type: ignore[arg-type]  # one of the two
            _turn(page, 0)
            expect(page.locator(".result .name").first).to_have_text("blue cube")
            page.wait_for_timeout(400)
            page.evaluate(watch)
            _turn(page, 100)
            expect(page.locator(".result .name").first).to_have_text("red tower")
            page.wait_for_timeout(100)
            assert (page.evaluate("window.seen") > 0) == glided
