"""Why two shapes differ: where on their surfaces, and in what."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, Page, Route, expect

from tests.accessible import assert_accessible
from tests.answering import answer_of, answering, blocks_served
from tests.serving import Serving
from tests.test_page_viewer import compare, pixels
from worker.pictures.preview import preview

EXPLAINED = {
    "method": "fused",
    "distance": 2.0,
    "scale": 0.1,
    "blocks": [
        {"name": "log-hks", "looks_at": "geometry", "share": 0.06, "placed": 1.0},
        {"name": "colour-histogram", "looks_at": "colour", "share": 0.82, "placed": 0.75},
        {"name": "colour-curves", "looks_at": "colour", "share": 0.12, "placed": 1.0},
    ],
}
REFUSED = {
    "code": "not_explained",
    "detail": "What this method compares has no place on the surface.",
    "status": 422,
    "title": "No",
}


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Serving, str]]:
    with blocks_served(tmp_path_factory.mktemp("library")) as served:
        yield served


def _explains(page: Page, explained: Any = EXPLAINED) -> list[str]:
    """Answer in the service's place; return the addresses that are asked for."""
    asked: list[str] = []
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    green = preview(corners, faces, np.full((4, 3), [0.0, 0.8, 0.0]))

    def answer(route: Route) -> None:
        asked.append(route.request.url)
        if ".glb" in route.request.url:
            route.fulfill(body=green)
        else:
            route.fulfill(json=explained)

    page.route("**/why/**", answer)
    return asked


def test_both_show_where_they_differ_and_the_shares_are_told(
    library: tuple[Serving, str], browser: Browser
) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}", browser) as page:
        asked = _explains(page)
        compare(page)
        before = [pixels(page, 0), pixels(page, 1)]
        page.get_by_role("button", name="Why they differ").click()
        shares = page.get_by_role("list", name="What the difference consists of").get_by_role("listitem")
        expect(shares).to_have_text(["Colours 82%", "Where the colours are 12%", "Shape 6%"])
        expect(page.get_by_text("differs most")).to_be_visible()
        expect(page.get_by_text("21% of the difference belongs to no place")).to_be_visible()  # ¼ of 82 %
        expect(page.get_by_text("The second, closer look of the ranking is not in this")).to_be_visible()
        page.wait_for_timeout(200)
        for place in (0, 1):
            assert np.mean(pixels(page, place) != before[place]) > 0.02
        assert len(asked) == 3
        assert_accessible(page)
        page.get_by_role("button", name="Colours", exact=True).click()
        page.wait_for_timeout(300)
        assert np.mean(pixels(page, 0) != before[0]) < 0.001


def test_it_explains_by_what_the_dial_says(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}?colour=100", browser) as page:
        asked = _explains(page)
        compare(page)
        page.get_by_role("button", name="Why they differ").click()
        expect(page.get_by_text("differs most")).to_be_visible()
        assert all("method=fused&weights=log-hks%3A0%2C" in address for address in asked)
        expect(page.get_by_text("second, closer look of the ranking")).to_have_count(0)


def test_the_next_result_is_explained_as_well(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}?colour=100", browser) as page:
        asked = _explains(page)
        compare(page, "red tower")
        page.get_by_role("button", name="Why they differ").click()
        expect(page.get_by_text("differs most")).to_be_visible()
        page.keyboard.press("PageDown")
        expect(page.get_by_text("differs most")).to_be_visible()
        assert len({address.split("/why/")[1].split("/")[0].split("?")[0] for address in asked}) == 2


def test_what_cannot_be_explained_is_said_and_the_colours_stay(
    library: tuple[Serving, str], browser: Browser
) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}?method=diffusion", browser, expected=("422",)) as page:
        page.route("**/why/**", answering(REFUSED, 422))
        compare(page)
        before = pixels(page, 1)
        page.get_by_role("button", name="Why they differ").click()
        expect(page.get_by_role("alert")).to_contain_text("has no place on the surface. (not_explained)")
        expect(page.get_by_role("button", name="Colours", exact=True)).to_have_attribute(
            "aria-pressed", "true"
        )
        assert np.mean(pixels(page, 1) != before) < 0.05  # the place is a line lower at most


def test_nothing_that_differs_is_said(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}", browser) as page:
        _explains(page, {**EXPLAINED, "distance": 0.0})
        compare(page)
        page.get_by_role("button", name="Why they differ").click()
        expect(page.get_by_text("Nothing that is compared differs.")).to_be_visible()
