"""The queue in words, and its lists: what a curator reads, from the numbers of the service."""

from collections.abc import Iterator
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

from tests.modules import modules

QUEUE: dict[str, Any] = {
    "queued": 1180,
    "processing": 2,
    "failed": 0,
    "oldest_queued_at": "2026-03-01T09:30:00Z",
    "workers": [{"name": "museum-1", "jobs": 2}],
    "finished": {"last_minute": 41, "last_hour": 1200},
    "median_seconds": 1.72,
    "expected_seconds": 170.0,
    "renewal": None,
}
LATER = 1772357520000  # 2026-03-01T09:32:00Z


@pytest.fixture(scope="module")
def page(browser: Browser) -> Iterator[Page]:
    with modules(browser) as page:
        yield page


def said(page: Page, function: str, **changes: Any) -> Any:
    call = f"async (queue) => (await import('/static/jobs/sentences.js')).{function}(queue, {LATER})"
    return page.evaluate(call, QUEUE | changes)


def test_what_there_is_to_do_and_until_when(page: Page) -> None:
    assert said(page, "workOf") == "2 running, 1,180 waiting; about 3 minutes left."
    assert "not known yet" in said(page, "workOf", expected_seconds=None)
    assert said(page, "workOf", queued=0, processing=0) == "Nothing is waiting."


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (3, "less than a minute"),
        (50, "about 1 minute"),
        (600, "about 10 minutes"),
        (8000, "about 2 hours"),
        (400_000, "about 5 days"),
    ],
)
def test_spans_of_time_are_guessed_as_people_do(page: Page, seconds: float, words: str) -> None:
    call = "async (seconds) => (await import('/static/jobs/sentences.js')).about(seconds)"
    assert page.evaluate(call, seconds) == words


def test_how_far_a_new_version_is_with_all_shapes(page: Page) -> None:
    assert said(page, "renewalOf", renewal=None) is None
    told = said(page, "renewalOf", renewal={"done": 1200, "failed": 0, "total": 20_000})
    assert told.startswith("1,200 of 20,000 shapes are described anew")
    assert "answer from the earlier descriptions" in told
    assert "1 shape could not be" in said(page, "renewalOf", renewal={"done": 0, "failed": 1, "total": 2})


def test_how_fast_it_goes(page: Page) -> None:
    told = said(page, "speedOf")
    assert told == "41 finished in the last minute, 1,200 in the last hour; 1.7 seconds each."
    none = {"last_minute": 0, "last_hour": 0}
    assert said(page, "speedOf", finished=none) == "Nothing was finished in the last hour."


def test_a_queue_that_nobody_works_on_is_told(page: Page) -> None:
    still = {"workers": [], "finished": {"last_minute": 0, "last_hour": 1200}}
    assert "No worker" in said(page, "stallOf", **still)
    assert said(page, "stallOf") is None
    assert said(page, "stallOf", **still, oldest_queued_at="2026-03-01T09:31:50Z") is None
    assert said(page, "stallOf", **still, queued=0) is None


MOVE = """async ([lists, shape, queue]) => {
  const { moved, gone, doubtful } = await import("/static/jobs/lists.js");
  const then = moved(lists, shape);
  const idsOf = ([status, { items }]) => [status, items.map(({ id }) => id)];
  const ids = Object.fromEntries(Object.entries(then).map(idsOf));
  return [ids, doubtful(then, queue), gone(then, shape.id).failed.items.length];
}"""


def shape(shape_id: str, minute: int, status: str) -> dict[str, str]:
    return {"id": shape_id, "created_at": f"2026-03-01T09:{minute:02}:00Z", "status": status}


def lists(cursor: str | None) -> dict[str, Any]:
    waiting = [shape("c", 30, "queued"), shape("a", 10, "queued")]
    return {
        "queued": {"items": waiting, "cursor": cursor},
        "processing": {"items": [shape("b", 20, "processing")], "cursor": None},
        "failed": {"items": [], "cursor": None},
    }


def test_a_shape_moves_to_the_list_of_its_state_in_its_place(page: Page) -> None:
    queue = {"queued": 3, "processing": 0, "failed": 0}
    ids, doubtful, _ = page.evaluate(MOVE, [lists(None), shape("b", 20, "queued"), queue])
    assert ids == {"queued": ["c", "b", "a"], "processing": [], "failed": []}
    assert doubtful == []
    ids, doubtful, failed = page.evaluate(MOVE, [lists(None), shape("b", 20, "failed"), queue])
    assert ids["failed"] == ["b"]
    assert doubtful == ["failed", "queued"]
    assert failed == 0


def test_what_is_older_than_what_was_read_waits_for_the_next_page(page: Page) -> None:
    queue = {"queued": 9, "processing": 0, "failed": 0}
    ids, doubtful, _ = page.evaluate(MOVE, [lists("more"), shape("b", 5, "queued"), queue])
    assert ids["queued"] == ["c", "a"]
    assert doubtful == []
    ids, *_ = page.evaluate(MOVE, [lists("more"), shape("b", 20, "ready"), queue])
    assert ids == {"queued": ["c", "a"], "processing": [], "failed": []}
