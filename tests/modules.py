"""The page's modules in a browser without a service, for those that only calculate."""

from collections.abc import Iterator
from contextlib import contextmanager

from playwright.sync_api import Browser, Page, Route

from service.http.page_files import page_files
from tests.browsing import opened

NOWHERE = "http://127.0.0.1:9"


@contextmanager
def modules(browser: Browser) -> Iterator[Page]:
    """Open an empty tab that can import from ``/static/``."""
    with opened(browser) as page:
        page.route(f"{NOWHERE}/**", _answer)
        page.goto(f"{NOWHERE}/static/icon.svg")
        yield page


def _answer(route: Route) -> None:
    file = page_files()[route.request.url.removeprefix(f"{NOWHERE}/static/")]
    route.fulfill(body=file.content, content_type=file.media_type)
