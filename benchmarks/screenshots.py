"""Draw the README's pictures of the page, with the sample creatures. Run by `make screenshots`."""

import io
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
from PIL import Image
from playwright.sync_api import Page, ViewportSize, expect

from tests.browsing import chromium_path, launched
from tests.serving import wait_until

DOCS = Path(__file__).parents[1] / "docs"
PORT = 8947
SIZE = ViewportSize(width=1280, height=800)
COLOURS = 256  # of a palette: a third of the bytes, and nobody sees it
QUERY, RESULT = "zebra giraffe, walking", "giraffe, walking"


def main() -> None:
    """Index the samples, open the page, take pictures."""
    executable = chromium_path()
    if executable is None:
        raise SystemExit("no Chromium on this machine; with apt: apt-get install chromium")
    with (
        tempfile.TemporaryDirectory() as folder,
        _serving(Path(folder)) as address,
        launched(executable) as browser,
    ):
        page = browser.new_page(viewport=SIZE, reduced_motion="reduce")
        for name, show in PICTURES.items():
            page.goto(address)
            show(page)
            _take(page, DOCS / f"page-{name}.png")


@contextmanager
def _serving(folder: Path) -> Iterator[str]:
    """Start the service as `make run` does; wait until every sample is described."""
    faience = Path(sys.executable).with_name("faience")
    address = f"http://127.0.0.1:{PORT}/"
    command = [str(faience), "serve", "--samples", "--port", str(PORT), "--data-dir", str(folder)]
    with subprocess.Popen(command) as process:
        try:
            wait_until(lambda: _described(address))
            yield address
        finally:
            process.terminate()


def _described(address: str) -> bool:
    try:
        counts = httpx.get(f"{address}v1/counts").json()
    except httpx.TransportError:  # it has not started yet
        return False
    return bool(counts["ready"] and counts["ready"] == counts["total"])


def _library(page: Page) -> None:
    expect(page.get_by_role("link", name=QUERY)).to_be_visible()
    page.wait_for_function("() => [...document.images].slice(0, 20).every((image) => image.complete)")


def _answer(page: Page) -> None:
    page.get_by_role("link", name=QUERY).click()
    expect(page.get_by_text("recoloured").first).to_be_visible()


def _why(page: Page) -> None:
    _answer(page)
    page.get_by_role("button", name=f"4. {RESULT}").click()
    page.get_by_role("button", name="Why they differ").click()
    expect(page.get_by_text("differs most")).to_be_visible()
    page.wait_for_timeout(3000)  # the models are drawn without telling


PICTURES: dict[str, Callable[[Page], None]] = {"library": _library, "answer": _answer, "why": _why}


def _take(page: Page, target: Path) -> None:
    picture = Image.open(io.BytesIO(page.screenshot()))
    picture.convert("RGB").quantize(COLOURS).save(target, optimize=True)
    print(f"{target.name}: {target.stat().st_size:,} bytes")


if __name__ == "__main__":
    main()
