"""Every view for everybody: axe in both schemes, by keys alone, and no wider than a phone."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, ViewportSize, expect

from index.keys import Keys
from index.scopes import Scope
from service.jobs.describing import describe_files
from tests.accessible import assert_accessible
from tests.browsing import DESK, PHONE, opened
from tests.copies import HOSTILE, add_copies
from tests.keyboard import assert_reachable
from tests.serving import Serving, serving, settings_for, wait_until
from tests.small_library import good_mesh, open_small_library

NARROW = ViewportSize(width=320, height=640)
LONG = "a_name_without_any_gap_that_goes_on_" * 12
WIDER = "() => document.documentElement.scrollWidth - innerWidth"
FLAT = b"v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n"  # read at once, refused by the worker


@dataclass(frozen=True, kw_only=True)
class Library:
    """A service and the ids of shapes in it."""

    service: Serving
    ready: str
    failed: str


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Library]:
    settings = settings_for(tmp_path_factory.mktemp("library"))
    with serving(settings, describe=describe_files, open_library=open_small_library) as service:
        ready, _ = add_copies(service, 0, HOSTILE, LONG)
        one, other = add_copies(service, 1, "amphora", "amphora, again")
        service.client.patch(
            f"/v1/shapes/{ready}", json={"metadata": {"tags": ["vase", LONG[:100]], "room": LONG}}
        )
        service.client.put(f"/v1/duplicates/dismissals/{one}/{other}")
        failed = service.add({"flat.obj": FLAT}, name=f"flat {LONG}").json()["id"]
        yield Library(service=service, ready=ready, failed=failed)


def nothing(page: Page) -> None:
    """Leave the view as it opens."""


def evidence(page: Page) -> None:
    page.get_by_text("Why the two are together").click()
    page.get_by_text("Pairs that somebody called no duplicates").click()
    expect(page.get_by_role("button", name="Take back")).to_be_visible()


def question(page: Page) -> None:
    page.get_by_role("button", name="Remove…").first.click()
    expect(page.get_by_role("dialog")).to_be_visible()


def dock(page: Page) -> None:
    """Show uploads: one that is refused, one that is known, one that was compared."""
    files = [
        {"name": "vase.obj", "mimeType": "", "buffer": b"mtllib vase.mtl\n" + FLAT},
        {"name": f"{LONG}.ply", "mimeType": "", "buffer": good_mesh(5)["good.ply"]},
    ]
    with page.expect_file_chooser() as chooser:
        page.get_by_role("button", name="Add meshes").click()
    chooser.value.set_files(files)  # type: ignore[arg-type]
    expect(page.locator("#adding")).to_contain_text("1 of 2 ready, 1 refused")


def beside(page: Page) -> None:
    page.locator(".result .look").first.click()
    expect(page.get_by_role("dialog")).to_be_visible()


@dataclass(frozen=True, kw_only=True)
class View:
    """A view: its address after ``#``, what is seen once it is there, and what is opened then."""

    address: str
    shows: str
    prepare: Callable[[Page], None] = nothing


VIEWS = {
    "library": View(address="/", shows=".card img"),
    "library, filtered": View(address="/?q=nobody", shows=".empty"),
    "library, with uploads": View(address="/", shows=".card img", prepare=dock),
    "shape": View(address="/shapes/{ready}/details", shows="h1"),
    "shape, removing": View(address="/shapes/{ready}/details", shows="h1", prepare=question),
    "shape, failed": View(address="/shapes/{failed}/details", shows="h1"),
    "answer": View(address="/shapes/{ready}", shows=".result"),
    "answer, in 3D": View(address="/shapes/{ready}", shows=".result", prepare=beside),
    "answer, of a failed shape": View(address="/shapes/{failed}", shows="h1"),
    "answer, forgotten": View(address="/queries/nobody", shows="h1"),
    "duplicates": View(address="/duplicates", shows="article", prepare=evidence),
    "duplicates, removing": View(address="/duplicates", shows="article", prepare=question),
    "duplicates, none": View(address="/duplicates?relation=re_posed", shows=".empty"),
    "jobs": View(address="/jobs", shows=".job"),
    "what is not there": View(address="/shapes/nobody/details", shows="[role=alert]"),
}


def show(page: Page, library: Library, view: View) -> None:
    address = view.address.format(ready=library.ready, failed=library.failed)
    page.goto(f"{library.service.client.base_url}#{address}")
    expect(page.locator(view.shows).first).to_be_visible()
    view.prepare(page)


def assert_narrow(page: Page) -> None:
    for viewport in (PHONE, NARROW):
        page.set_viewport_size(viewport)
        page.wait_for_timeout(100)  # what is measured by script follows
        assert page.evaluate(WIDER) <= 0, f"wider than {viewport['width']}"


@pytest.mark.parametrize("name", VIEWS)
def test_every_view_is_for_everybody(library: Library, browser: Browser, name: str) -> None:
    with opened(browser, DESK, expected=("404", "422")) as page:
        show(page, library, VIEWS[name])
        assert_reachable(page)
        assert_accessible(page)
        assert_narrow(page)
        page.set_viewport_size(PHONE)
        assert_accessible(page)
        assert_reachable(page)


def test_the_form_for_a_key_is_for_everybody(tmp_path: Path, browser: Browser) -> None:
    with serving(settings_for(tmp_path), open_library=open_small_library) as service:
        Keys(service.library.engine).create("reader", Scope.READ)
        wait_until(lambda: service.client.get("/v1/methods").status_code == 401)
        with opened(browser, expected=("401",)) as page:
            page.goto(str(service.client.base_url))
            expect(page.get_by_label("Key")).to_be_visible()
            assert_reachable(page)
            assert_accessible(page)
            assert_narrow(page)


def test_an_empty_library_is_for_everybody(tmp_path: Path, browser: Browser) -> None:
    with serving(settings_for(tmp_path), open_library=open_small_library) as service, opened(browser) as page:
        for address, shows in {"/": ".empty", "/duplicates": ".empty", "/jobs": ".work"}.items():
            page.goto(f"{service.client.base_url}#{address}")
            expect(page.locator(shows)).to_be_visible()
            assert_reachable(page)
            assert_accessible(page)
            assert_narrow(page)
            page.set_viewport_size(DESK)
