"""What was called no duplicate stays so after a restart, until somebody takes it back."""

from functools import partial
from pathlib import Path

from playwright.sync_api import Browser, Page, expect

from service.jobs.describing import describe_files
from tests.accessible import assert_accessible
from tests.browsing import opened
from tests.copies import HOSTILE, add_copies
from tests.serving import serving, settings_for
from tests.small_library import open_small_library
from tests.test_page_duplicates import show


def dismissed(page: Page) -> None:
    page.get_by_text("Pairs that somebody called no duplicates").click()


def test_dismissed_survives_a_restart_and_can_be_taken_back(tmp_path: Path, browser: Browser) -> None:
    start = partial(serving, settings_for(tmp_path), describe=describe_files, open_library=open_small_library)
    with start() as service:
        add_copies(service, 0, "amphora", HOSTILE)
        with opened(browser) as page:
            show(page, service)
            page.get_by_role("button", name="Not a duplicate").click()
            expect(page.get_by_role("button", name="Undo")).to_be_visible()
    with start() as service, opened(browser) as page:
        show(page, service)
        expect(page.get_by_role("heading", name="No duplicates were found")).to_be_visible()
        dismissed(page)
        pair = page.get_by_role("listitem").filter(has_text="amphora")
        expect(pair.get_by_role("link", name=HOSTILE)).to_be_visible()
        assert pair.locator("img").count() == 2
        assert_accessible(page)
        pair.get_by_role("button", name="Take back").click()
        expect(page.locator("#taken-back")).to_be_focused()
        page.get_by_role("button", name="Look again").click()
        expect(page.get_by_role("article")).to_be_visible()
        expect(page.get_by_text("Nobody has dismissed a pair.")).to_be_visible()
        page.reload()
        expect(page.get_by_role("article")).to_be_visible()


def test_a_pair_of_a_group_that_is_shown_comes_back_at_once(tmp_path: Path, browser: Browser) -> None:
    with serving(settings_for(tmp_path), describe=describe_files, open_library=open_small_library) as service:
        add_copies(service, 0, "amphora", "copy")
        with opened(browser) as page:
            show(page, service)
            page.get_by_role("button", name="Not a duplicate").click()
            dismissed(page)
            page.get_by_role("button", name="Take back").click()
            expect(page.get_by_text("they are shown above")).to_be_visible()
            expect(page.get_by_role("article")).to_be_visible()
            assert page.get_by_role("button", name="Undo").count() == 0
