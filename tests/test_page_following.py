"""What becomes of a shape is heard of, also where it happened while nobody listened."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page

from service.jobs.describing import describe_files
from tests.browsing import opened
from tests.serving import Serving, serving, settings_for
from tests.small_library import good_mesh, open_small_library

FOLLOW = """async (id) => {
  const { addUpload } = await import("/static/adding/uploads.js");
  const { follow, startFollowing } = await import("/static/adding/following.js");
  window.upload = addUpload("add", { path: "a.ply", file: new File(["x"], "a.ply") }, { files: [] });
  startFollowing();
  follow(window.upload, { id, name: "a", status: "queued" }, false); // as it was when it was accepted
}"""
CUT = "ERR_FAILED"


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    settings = settings_for(tmp_path_factory.mktemp("library"))
    with serving(settings, describe=describe_files, open_library=open_small_library) as running:
        yield running


def ready_shape(service: Serving, number: int) -> str:
    """Add a shape that is ready before the page follows it."""
    return str(service.add(good_mesh(number)).json()["id"])


def state(page: Page, expected: str) -> None:
    """Wait for a state of the upload."""
    page.wait_for_function("expected => window.upload.state === expected", arg=expected)


def test_a_shape_that_changed_before_it_was_followed_is_looked_at(service: Serving, browser: Browser) -> None:
    with opened(browser, expected=(CUT,)) as page:
        page.goto(str(service.client.base_url))
        page.route("**/v1/events", lambda route: route.abort())
        page.evaluate(FOLLOW, ready_shape(service, 1))
        state(page, "ready")


def test_what_happened_while_the_stream_was_cut_is_asked_for(service: Serving, browser: Browser) -> None:
    with opened(browser, expected=(CUT,)) as page:
        page.goto(str(service.client.base_url))
        page.route("**/v1/**", lambda route: route.abort())
        page.evaluate(FOLLOW, ready_shape(service, 2))
        page.wait_for_timeout(300)
        state(page, "queued")
        page.unroute_all()
        state(page, "ready")
