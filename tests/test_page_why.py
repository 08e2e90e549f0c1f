"""Why two shapes differ: where on their surfaces, and in what."""

from collections.abc import Iterator

import numpy as np
import pytest
from playwright.sync_api import Browser, Page, expect

from tests.accessible import assert_accessible
from tests.answering import CUBE, RED, add, answer_of, block, blocks_served
from tests.copies import exported_anew
from tests.serving import Serving
from tests.test_page_viewer import compare, pixels

WORDS = {"log-hks": "Shape", "colour-histogram": "Colours", "colour-curves": "Where the colours are"}
UNPLACED = "async (blocks) => (await import('/static/viewer/why.js')).unplaced(blocks)"


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Serving, str]]:
    with blocks_served(tmp_path_factory.mktemp("library")) as served:
        yield served


def _ask_why(page: Page) -> None:
    page.get_by_role("button", name="Why they differ").click()
    expect(page.get_by_text("differs most")).to_be_visible()
    page.wait_for_timeout(200)


def _shares(service: Serving, query: str, name: str) -> list[str]:
    """Return what the page should say, from the service's own numbers."""
    ranked = service.client.get(f"/v1/shapes/{query}/similar").json()["results"]
    other = next(result["shape"]["id"] for result in ranked if result["shape"]["name"] == name)
    blocks = service.client.get(f"/v1/shapes/{query}/why/{other}").json()["blocks"]
    told = [(block["share"], WORDS[block["name"]]) for block in blocks]
    return [f"{word} {round(100 * share)}%" for share, word in sorted(told, reverse=True)]


def test_both_show_where_they_differ_and_the_shares_are_told(
    library: tuple[Serving, str], browser: Browser
) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}", browser) as page:
        compare(page, "red tower")
        before = [pixels(page, 0), pixels(page, 1)]
        _ask_why(page)
        shares = page.get_by_role("list", name="What the difference consists of").get_by_role("listitem")
        expect(shares).to_have_text(_shares(service, query, "red tower"))
        expect(page.get_by_text("The second, closer look of the ranking is not in this")).to_be_visible()
        for place in (0, 1):
            assert np.mean(pixels(page, place) != before[place]) > 0.02
        assert_accessible(page)
        page.get_by_role("button", name="Colours", exact=True).click()
        page.wait_for_timeout(300)
        assert np.mean(pixels(page, 0) != before[0]) < 0.001  # the camera stayed


def test_it_explains_by_what_the_dial_says(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}?colour=0", browser) as page:
        compare(page, "red tower")
        _ask_why(page)
        shares = page.get_by_role("list", name="What the difference consists of").get_by_role("listitem")
        expect(shares.first).to_have_text("Shape 100%")
        expect(page.get_by_text("second, closer look of the ranking")).to_have_count(0)


def test_the_next_result_is_explained_as_well(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}?colour=0", browser) as page:
        expect(page.locator(".result")).to_have_count(3)
        compare(page, "blue cube")  # the nearest by its shape, which is the same
        page.get_by_role("button", name="Why they differ").click()
        expect(page.get_by_text("Nothing that is compared differs.")).to_be_visible()
        page.keyboard.press("PageDown")
        expect(page.get_by_text("Shape 100%")).to_be_visible()


def test_methods_without_places_say_so_and_the_colours_stay(
    library: tuple[Serving, str], browser: Browser
) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}?method=diffusion", browser, expected=("422",)) as page:
        compare(page)
        before = pixels(page, 1)
        page.get_by_role("button", name="Why they differ").click()
        expect(page.get_by_role("alert")).to_contain_text("(not_explained)")
        expect(page.get_by_role("button", name="Colours", exact=True)).to_have_attribute(
            "aria-pressed", "true"
        )
        assert np.mean(pixels(page, 1) != before) < 0.001


def test_nothing_that_differs_is_said(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library
    copy = add(service, exported_anew(block(CUBE, RED), 1), "copy")
    with answer_of(service, f"/#/shapes/{query}", browser) as page:
        compare(page, "copy")
        page.get_by_role("button", name="Why they differ").click()
        expect(page.get_by_text("Nothing that is compared differs.")).to_be_visible()
    service.client.delete(f"/v1/shapes/{copy}")


def test_a_dropped_mesh_is_explained_too(library: tuple[Serving, str], browser: Browser) -> None:
    service, _ = library
    parts = [("files", file) for file in block(CUBE, RED, 9).items()]
    query = service.client.post("/v1/search", params={"remember": "true"}, files=parts).json()["query"]
    with answer_of(service, f"/#/queries/{query['id']}", browser) as page:
        compare(page, "red tower")
        _ask_why(page)
        expect(page.get_by_role("list", name="What the difference consists of")).to_contain_text("Shape")


def test_what_is_nowhere_counts_by_its_share(library: tuple[Serving, str], browser: Browser) -> None:
    with answer_of(library[0], "/", browser) as page:
        blocks = [{"share": 0.8, "placed": 0.75}, {"share": 0.2, "placed": 1.0}]
        assert page.evaluate(UNPLACED, blocks) == pytest.approx(0.2)
