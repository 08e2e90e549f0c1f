"""A real browser, for tests that use the page as people do."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager

from playwright.sync_api import Browser, ConsoleMessage, Page, ViewportSize, expect, sync_playwright

NAMES = ("chromium", "chromium-browser", "google-chrome")
FLAGS = (
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
    "--disable-gpu-rasterization",  # without a GPU, pages themselves are drawn three times as fast like this
    "--disable-gpu-compositing",
    "--use-angle=swiftshader",  # WebGL without a GPU
    "--enable-unsafe-swiftshader",
)
SLOW = "GL Driver Message (OpenGL, Performance"  # a picture of the page has to be read back from WebGL
DESK = ViewportSize(width=1280, height=800)
PHONE = ViewportSize(width=390, height=844)
PATIENCE = 60_000.0  # milliseconds; machines are shared

expect.set_options(timeout=PATIENCE)


def chromium_path() -> str | None:
    """Return where the system's Chromium is; None where there is none."""
    return next(filter(None, map(shutil.which, NAMES)), None)


@contextmanager
def launched(executable: str) -> Iterator[Browser]:
    """Start a browser; end it."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=executable, args=list(FLAGS), chromium_sandbox=False
        )
        try:
            yield browser
        finally:
            browser.close()


@contextmanager
def opened(
    browser: Browser, viewport: ViewportSize = DESK, *, touch: bool = False, expected: tuple[str, ...] = ()
) -> Iterator[Page]:
    """Open a tab of its own; complain about what its console complains about, and of addresses elsewhere.

    Parameters
    ----------
    expected : tuple of str
        Parts of console messages that belong to the test, such as a status that it provokes.
    """
    context = browser.new_context(
        viewport=viewport, has_touch=touch, is_mobile=touch, reduced_motion="reduce"
    )
    context.set_default_timeout(PATIENCE)
    page = context.new_page()
    complaints: list[str] = []

    def note(message: ConsoleMessage) -> None:
        harmless = (*expected, SLOW)
        if message.type in ("error", "warning") and not any(part in message.text for part in harmless):
            complaints.append(f"{message.text} ({message.location['url']})")

    page.on("console", note)
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on("request", lambda request: complaints.extend(_elsewhere(request.url)))
    try:
        yield page
    finally:
        context.close()
    assert not complaints, complaints


def _elsewhere(address: str) -> list[str]:
    local = ("http://127.0.0.1:", "blob:http://127.0.0.1:", "data:")
    return [] if address.startswith(local) else [f"the page asked for {address}"]
