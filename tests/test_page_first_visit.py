"""The first visit: what somebody sees who opens the page for the first time."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, expect

from service.jobs.describing import describe_files
from tests.browsing import opened
from tests.serving import Serving, serving, settings_for
from tests.small_library import good_mesh, open_small_library


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    settings = settings_for(tmp_path_factory.mktemp("library"))
    with serving(settings, describe=describe_files, open_library=open_small_library) as running:
        yield running


def test_the_library_is_shown_by_pictures(service: Serving, browser: Browser) -> None:
    service.add(good_mesh(0), name="amphora")
    with opened(browser) as page:
        page.goto(str(service.client.base_url))
        expect(page.get_by_role("link", name="amphora")).to_be_visible()
        picture = page.locator(".card img")
        expect(picture).to_have_js_property("complete", True)
        assert picture.evaluate("image => image.naturalWidth") > 0


def test_the_page_names_the_modules_of_its_first_view(service: Serving, browser: Browser) -> None:
    """They are asked for at once instead of one after another; what is not in the first view waits."""
    with opened(browser) as page:
        with page.expect_response("**/v1/events"):
            page.goto(str(service.client.base_url))
        named = page.locator("link[rel=modulepreload]").evaluate_all("all => all.map(({href}) => href)")
        asked = page.evaluate("performance.getEntriesByType('resource').map(({name}) => name)")
        started = page.locator("script").evaluate_all("all => all.map(({src}) => src)")
    modules = {address for address in asked if address.endswith(".js")}
    later = {address for address in modules if address.endswith(("shared/live.js", "vendor/eventsource.js"))}
    assert len(later) == 2
    assert set(named) | set(started) == modules - later
