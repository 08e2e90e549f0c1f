"""Sending goes on when the service is away, has enough, or wants a key; nothing that was chosen is lost."""

import re
from collections.abc import Iterator
from contextlib import AbstractContextManager
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Dialog, Page, Route, expect

from index.keys import Keys
from index.scopes import Scope
from service.jobs.describing import describe_files
from service.settings import Settings
from tests.accessible import assert_accessible
from tests.browsing import opened
from tests.dragging import Drag, write
from tests.pages_of_uploads import row
from tests.serving import Serving, serving, settings_for, wait_until
from tests.small_library import good_mesh, open_small_library


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    with small(settings_for(tmp_path_factory.mktemp("library"))) as running:
        yield running


def small(settings: Settings) -> AbstractContextManager[Serving]:
    return serving(settings, describe=describe_files, open_library=open_small_library)


def meshes(folder: Path, *numbers: int) -> list[Path]:
    files = write(folder, {f"block {number}.ply": good_mesh(number)["good.ply"] for number in numbers})
    return [files / f"block {number}.ply" for number in numbers]


def enter(page: Page, key: str) -> None:
    page.get_by_label("Key").fill(key)
    page.get_by_role("button", name="Open").click()
    expect(page.get_by_role("heading", name="Library")).to_be_visible()


def test_a_service_that_is_away_is_waited_for(service: Serving, browser: Browser, tmp_path: Path) -> None:
    with opened(browser, expected=("ERR_CONNECTION_REFUSED",)) as page:
        page.goto(str(service.client.base_url))
        for path in ("**/v1/shapes", "**/livez"):
            page.route(path, lambda route: route.abort("connectionrefused"))
        Drag(page, *meshes(tmp_path, 1, 2)).drop_to_add()
        dock = page.get_by_role("complementary")
        expect(dock).to_contain_text("The service does not answer.")
        expect(dock).to_contain_text("Next try in")
        expect(row(page, "block 1")).to_contain_text("waiting to be sent")
        assert_accessible(page)
        page.unroute_all()
        expect(page.get_by_role("button", name="2 of 2 ready")).to_be_visible()  # by itself
        expect(dock).not_to_contain_text("does not answer")


def test_a_connection_that_always_breaks_is_no_service_that_is_away(
    service: Serving, browser: Browser, tmp_path: Path
) -> None:
    with opened(browser, expected=("ERR_CONNECTION_RESET",)) as page:
        page.goto(str(service.client.base_url))
        page.route("**/v1/shapes", lambda route: route.abort("connectionreset"))
        Drag(page, *meshes(tmp_path, 3)).drop_to_add()
        for _ in range(2):
            page.get_by_role("button", name="Try now").click()
        expect(row(page, "block 3")).to_contain_text("The connection broke again and again.")
        page.unroute_all()
        page.get_by_role("button", name="Try again").click()
        expect(row(page, "block 3")).to_contain_text("ready")


def test_a_file_that_was_moved_is_told_from_a_broken_connection(
    service: Serving, browser: Browser, tmp_path: Path
) -> None:
    held: list[Route] = []
    with opened(browser, expected=("ERR_",)) as page:
        page.goto(str(service.client.base_url))
        page.route("**/v1/shapes", lambda route: held.append(route))
        (file,) = meshes(tmp_path, 4)
        Drag(page, file).drop_to_add()
        expect(row(page, "block 4")).to_contain_text("sending")
        file.unlink()
        held[0].abort("failed")
        expect(row(page, "block 4")).to_contain_text("“block 4.ply” cannot be read any more")


def test_a_full_disk_stops_all_until_somebody_says(
    service: Serving, browser: Browser, tmp_path: Path
) -> None:
    full = (
        '{"code": "storage_full", "title": "The disk is full", "detail": "nothing of this request was kept"}'
    )
    with opened(browser, expected=("status of 507",)) as page:
        page.goto(str(service.client.base_url))
        page.route("**/v1/shapes", lambda route: route.fulfill(status=507, body=full))
        Drag(page, *meshes(tmp_path, 5, 6, 7, 8, 9)).drop_to_add()
        expect(page.get_by_role("complementary")).to_contain_text("The disk is full.")
        expect(row(page, "block 9")).to_contain_text("waiting to be sent")
        page.unroute_all()
        page.get_by_role("button", name="Go on").click()
        expect(page.get_by_role("button", name="5 of 5 ready")).to_be_visible()


def test_more_than_the_service_takes_is_refused_in_words(browser: Browser, tmp_path: Path) -> None:
    settings = settings_for(tmp_path / "library", workers=0, max_body_bytes=2**20)
    files = write(tmp_path, {"huge.ply": bytes(30 * 2**20)})
    with serving(settings) as narrow, opened(browser, expected=("status of 413",)) as page:
        page.goto(str(narrow.client.base_url))
        Drag(page, files / "huge.ply").drop_to_add()
        expect(row(page, "huge")).to_contain_text("This is more than the service takes at once.")


def test_a_key_that_sent_enough_waits_and_goes_on(browser: Browser, tmp_path: Path) -> None:
    settings = settings_for(tmp_path / "library", api_keys=("a-key",), uploads_per_minute=1)
    with small(settings) as keyed, opened(browser, expected=("status of 401", "status of 429")) as page:
        page.goto(str(keyed.client.base_url))
        enter(page, "a-key")
        Drag(page, *meshes(tmp_path, 1, 2)).drop_to_add()
        expect(page.locator(".upload").filter(has_text="ready")).to_have_count(1)  # whichever came first
        expect(page.get_by_role("complementary")).to_contain_text("As many as this key may send in a minute.")
        expect(page.get_by_text(re.compile(r"Next try in [3-5]\d s"))).to_be_visible()  # as the service said
        expect(page.locator(".upload").filter(has_text="waiting to be sent")).to_have_count(1)


@pytest.mark.parametrize("scope", [Scope.READ, None])
def test_a_key_that_may_not_add_is_exchanged_and_nothing_is_lost(
    browser: Browser, tmp_path: Path, scope: Scope | None
) -> None:
    settings = settings_for(tmp_path / "library", api_keys=("writes",))
    with small(settings) as keyed, opened(browser, expected=("status of 401", "status of 403")) as page:
        lesser = Keys(keyed.library.engine).create("visitor", scope)[1] if scope else "revoked"
        expected = 200 if scope else 401
        bearing = {"Authorization": f"Bearer {lesser}"}
        wait_until(lambda: keyed.client.get("/v1/shapes", headers=bearing).status_code == expected)
        page.goto(str(keyed.client.base_url))
        enter(page, "writes")
        page.evaluate("key => sessionStorage.setItem('key', key)", lesser)
        Drag(page, *meshes(tmp_path, 1, 2)).drop_to_add()
        title = "This key may look, not add." if scope else "The library needs a key."
        expect(page.get_by_role("complementary")).to_contain_text(title)
        page.get_by_role("button", name="Enter a key").click()
        enter(page, "writes")
        page.get_by_role("button", name="Go on").click()
        expect(page.get_by_role("button", name="2 of 2 ready")).to_be_visible()
        expect(row(page, "block 1").locator("img")).to_have_js_property("complete", True)


def test_leaving_while_something_is_sent_is_asked_about(
    service: Serving, browser: Browser, tmp_path: Path
) -> None:
    held: list[Route] = []
    asked: list[str] = []
    with opened(browser) as page:
        page.goto(str(service.client.base_url))

        def stay(dialog: Dialog) -> None:
            asked.append(dialog.type)
            dialog.dismiss()

        page.on("dialog", stay)
        page.route("**/v1/shapes", lambda route: held.append(route))
        Drag(page, *meshes(tmp_path, 10)).drop_to_add()
        expect(row(page, "block 10")).to_contain_text("sending")
        page.get_by_role("heading", name="Library").click()  # browsers ask only where somebody did something
        page.close(run_before_unload=True)
        page.wait_for_timeout(500)
        assert asked == ["beforeunload"]
        page.get_by_role("button", name="Cancel block 10").click()
        expect(page.get_by_role("complementary")).to_be_hidden()


def test_at_most_three_are_sent_at_once(service: Serving, browser: Browser, tmp_path: Path) -> None:
    held: list[Route] = []
    with opened(browser) as page:
        page.goto(str(service.client.base_url))
        page.route("**/v1/shapes", lambda route: held.append(route))
        Drag(page, *meshes(tmp_path, *range(11, 17))).drop_to_add()
        expect(page.locator(".upload").filter(has_text="sending")).to_have_count(3)
        page.wait_for_timeout(300)
        assert len(held) == 3
        page.route("**/v1/shapes", lambda route: route.continue_())
        for route in held:
            route.continue_()
        expect(page.get_by_role("button", name="6 of 6 ready")).to_be_visible()
