"""Every refusal that somebody may meet with on the page is put into words, with what to do."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page

from service.http.reasons import CHANGING, DESCRIBING, FAILURES, UPLOAD, by_status
from tests.browsing import opened
from tests.serving import serving, settings_for

# Forms that the page does not write, and what is nobody's fault but the service's.
NOT_MET = {"not_multipart", "bad_multipart", "bad_field", "bad_metadata", "no_files", "invalid_request"}


@pytest.fixture(scope="module")
def page(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    with serving(settings_for(tmp_path_factory.mktemp("library"))) as service, opened(browser) as page:
        page.goto(str(service.client.base_url))
        yield page


def words(page: Page, code: str, status: int) -> tuple[str, str]:
    """Return the title and what to do."""
    script = '(problem) => import("/static/adding/refusals.js").then(({ inWords }) => inWords(problem))'
    found = page.evaluate(script, {"code": code, "status": status})
    return found["title"], found["action"]


def test_each_code_of_an_upload_has_words_of_its_own(page: Page) -> None:
    codes = {(code, 422) for code in FAILURES}
    for status, some in by_status([*CHANGING, *UPLOAD, *DESCRIBING]).items():
        codes |= {(code, status) for code in some if code not in NOT_MET}
    unknown = {words(page, "no-such-code", 422), words(page, "no-such-code", 503)}
    wordless = sorted(code for code, status in codes if words(page, code, status) in unknown)
    assert wordless == ["busy", "too_busy"]  # what is said of 503 says it


def test_an_unknown_code_has_words_too(page: Page) -> None:
    assert words(page, "constructor", 422) == words(page, "no-such-code", 422)
    assert all(words(page, "no-such-code", 422))
