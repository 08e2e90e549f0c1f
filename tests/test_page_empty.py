"""A library with little to see says what to do first."""

from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect

from tests.accessible import assert_accessible
from tests.browsing import opened
from tests.fakes import coloured_triangle
from tests.serving import serving, settings_for


def test_an_empty_library_says_what_to_do_first(tmp_path: Path, browser: Browser) -> None:
    with serving(settings_for(tmp_path, workers=0)) as service, opened(browser) as page:
        page.goto(str(service.client.base_url))
        expect(page.get_by_role("heading", name="Nothing is here yet")).to_be_visible()
        expect(page.get_by_text("faience index scans/")).to_be_visible()
        expect(page.get_by_role("search")).to_have_count(0)
        assert_accessible(page)


@pytest.mark.parametrize(
    ("number", "words"), [(1, "The shape is still being described"), (2, "All 2 shapes are")]
)
def test_a_library_that_is_still_described_says_so(
    tmp_path: Path, browser: Browser, number: int, words: str
) -> None:
    with serving(settings_for(tmp_path, workers=0)) as service, opened(browser) as page:
        for each in range(number):
            service.add({"a.ply": coloured_triangle(each)}, wait=0)
        page.goto(str(service.client.base_url))
        expect(page.get_by_text(words)).to_be_visible()
        expect(page.locator(".card")).to_have_count(number)
        assert_accessible(page)
