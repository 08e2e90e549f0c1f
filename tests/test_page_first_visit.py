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
