"""The page of jobs: what runs, waits and failed, as it happens, and how to try again."""

from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, Route, expect

from tests.accessible import assert_accessible
from tests.browsing import PHONE, opened
from tests.copies import HOSTILE
from tests.fakes import coloured_triangle, describe_quickly
from tests.serving import Serving, serving, settings_for
from worker.describe import Description
from worker.errors import Code, MeshError
from worker.parameters import Parameters
from worker.reading.limits import Limits


def describe_unless(
    narrow: Path, files: Mapping[str, bytes], allow_untextured: bool, parameters: Parameters, limits: Limits
) -> Description:
    """Refuse everything as long as a file is there, as a worker with little memory does."""
    if narrow.exists():
        raise MeshError(Code.TOO_COMPLEX, "it needs more memory than a mesh may take")
    return describe_quickly(files, allow_untextured, parameters, limits)


@pytest.fixture
def narrow(tmp_path: Path) -> Path:
    return tmp_path / "narrow"


@pytest.fixture
def service(tmp_path: Path, narrow: Path) -> Iterator[Serving]:
    settings = settings_for(tmp_path / "library", workers=1)
    with serving(settings, describe=partial(describe_unless, narrow)) as running:
        yield running


def show(page: Page, service: Serving) -> None:
    page.goto(f"{service.client.base_url}#/jobs")
    expect(page.get_by_role("heading", name="Jobs")).to_be_visible()


def fail(service: Serving, narrow: Path, *names: str) -> list[str]:
    narrow.touch()
    added = [service.add({"a.ply": coloured_triangle(place)}, name=name) for place, name in enumerate(names)]
    narrow.unlink()
    return [answer.json()["id"] for answer in added]


def test_an_idle_library_says_so_and_what_to_do(service: Serving, browser: Browser) -> None:
    with opened(browser, PHONE) as page:
        show(page, service)
        expect(page.get_by_text("Nothing is waiting. Drop meshes anywhere")).to_be_visible()
        assert page.get_by_role("region").count() == 0
        assert_accessible(page)


def test_what_runs_and_waits_is_shown_as_it_changes(service: Serving, browser: Browser) -> None:
    with opened(browser) as page:
        with page.expect_response("**/v1/events"):
            show(page, service)
        stuck = service.add({"hang.ply": coloured_triangle()}, wait=0, name="stuck").json()["id"]
        running = page.get_by_role("region", name="Running")
        expect(running.get_by_role("link", name="stuck")).to_have_attribute(
            "href", f"#/shapes/{stuck}/details"
        )
        for number in range(35):
            service.add({"b.ply": coloured_triangle(number)}, wait=0, name=f"vase {number}")
        waiting = page.get_by_role("region", name="Waiting")
        expect(waiting.get_by_role("link", name="vase 34")).to_be_visible()
        expect(page.get_by_text("2 running, 34 waiting; how long it takes is not known yet.")).to_be_visible()
        expect(page.get_by_role("list", name="Workers").get_by_role("listitem")).to_contain_text(
            "holds 2 jobs"
        )
        assert_accessible(page)
        page.reload()
        expect(waiting.get_by_role("listitem")).to_have_count(30)
        page.get_by_role("button", name="Show more (Waiting)").click()
        expect(waiting.get_by_role("link", name="vase 3", exact=True)).to_be_visible()
        service.client.delete(f"/v1/shapes/{stuck}")
        expect(running.get_by_role("link", name="stuck")).to_have_count(0)


def test_a_failure_is_told_with_its_reason_and_can_be_tried_again(
    service: Serving, narrow: Path, browser: Browser
) -> None:
    (failed,) = fail(service, narrow, HOSTILE)
    with opened(browser) as page:
        show(page, service)
        row = page.get_by_role("region", name="Failed").get_by_role("listitem")
        expect(row).to_contain_text("it needs more memory than a mesh may take")
        expect(row).to_contain_text("too_complex")
        expect(row.get_by_role("link", name=HOSTILE)).to_have_attribute("href", f"#/shapes/{failed}/details")
        assert_accessible(page)
        row.get_by_role("button", name="Try again").press("Enter")
        expect(page.get_by_role("heading", name="Jobs")).to_be_focused()
        expect(page.get_by_role("region", name="Failed")).to_have_count(0)
        assert service.settled(failed)["status"] == "ready"
        expect(page.get_by_text("2 finished in the last minute, 2 in the last hour;")).to_be_visible()


def test_all_that_failed_is_tried_again_once(service: Serving, narrow: Path, browser: Browser) -> None:
    ids = fail(service, narrow, "one", "two", "three", "four")
    narrow.touch()  # they fail again
    with opened(browser) as page:
        asked: list[str] = []
        page.on("request", lambda request: asked.extend([request.url] if request.method == "POST" else []))
        show(page, service)
        page.get_by_role("button", name="Try all again").click()
        expect(page.get_by_role("status")).to_contain_text("What failed was queued again.")
        assert sorted(asked) == sorted(f"{service.client.base_url}/v1/shapes/{one}/retry" for one in ids)
        expect(page.get_by_role("region", name="Failed").get_by_role("listitem")).to_have_count(4)


def test_what_was_retried_elsewhere_is_no_error_and_a_refusal_is_told(
    service: Serving, narrow: Path, browser: Browser
) -> None:
    fail(service, narrow, "one")
    with opened(browser, expected=("503",)) as page:
        show(page, service)
        page.route("**/retry", lambda route: route.fulfill(status=503, json=busy()))
        page.get_by_role("button", name="Try again (one)").click()
        expect(page.get_by_role("alert")).to_contain_text("Too much to do. busy")
        page.get_by_role("button", name="Try all again").click()
        expect(page.get_by_role("region").get_by_role("alert").first).to_contain_text("busy")


def busy() -> dict[str, object]:
    return {"code": "busy", "detail": "Too much to do.", "status": 503, "title": "", "type": ""}


def test_the_queue_is_asked_for_again_and_again_also_after_a_refusal(
    service: Serving, browser: Browser
) -> None:
    with opened(browser, expected=("503",)) as page:
        show(page, service)
        answers = [busy()]

        def answer(route: Route) -> None:
            if answers:
                route.fulfill(status=503, json=answers.pop())
            else:
                route.fulfill(json=route.fetch().json() | {"queued": 7, "expected_seconds": 100})

        page.route("**/v1/queue", answer)
        expect(page.get_by_role("alert")).to_contain_text("Too much to do.")
        expect(page.get_by_text("0 running, 7 waiting; about 2 minutes left.")).to_be_visible()
        expect(page.get_by_role("alert")).to_have_count(0)
