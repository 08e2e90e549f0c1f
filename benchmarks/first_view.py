"""What the first view of a library costs the service and the browser, against that of an empty one.

Run by ``python -m benchmarks.first_view``; needs the system's Chromium.
"""

import multiprocessing
import statistics
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import httpx
from playwright.sync_api import Browser, CDPSession, Page, expect
from prometheus_client.parser import text_string_to_metric_families

from benchmarks.made_library import make_library
from benchmarks.pages import Row, table_of
from benchmarks.timed_server import TimedServer
from tests.browsing import DESK, chromium_path, launched

SHAPES = 2_000
VISITS = 5  # medians of so many, each by a browser that has seen nothing, after one to warm the server up
SETTLED = 1000  # milliseconds after the last picture, for what the page asks for later

Cost = Mapping[str, float]  # column → number


def rows(n_shapes: int = SHAPES, n_visits: int = VISITS) -> list[Row]:
    """Measure; the libraries are made in folders that are gone afterwards.

    Returns
    -------
    list of mapping
        Milliseconds but for the counts. `server` is the processor time of the whole process, `requests` the
        time that requests took by its own /metrics; `script` and `all tasks` are what Chromium tells of the
        page: tasks are scripts, style, layout and painting.
    """
    executable = chromium_path()
    if executable is None:
        raise FileNotFoundError("no Chromium on this machine; with apt: apt-get install chromium")
    with launched(executable) as browser:
        return [
            _row("empty", _visits(browser, 0, n_visits)),
            _row(f"{n_shapes:,} shapes", _visits(browser, n_shapes, n_visits)),
        ]


def _row(library: str, visits: Sequence[Cost]) -> Row:
    medians = {column: statistics.median(visit[column] for visit in visits) for column in visits[0]}
    return {"library": library, **{column: f"{value:,.0f}" for column, value in medians.items()}}


def _visits(browser: Browser, n_shapes: int, n_visits: int) -> list[Cost]:
    with tempfile.TemporaryDirectory() as folder:
        make_library(Path(folder), n_shapes)
        with TimedServer(Path(folder), multiprocessing.get_context("spawn")) as server:
            return [_visit(browser, server, n_shapes) for _ in range(1 + n_visits)][1:]


def _visit(browser: Browser, server: TimedServer, n_shapes: int) -> Cost:
    """Open the page with an empty cache; return what it cost."""
    context = browser.new_context(viewport=DESK)
    page, address = context.new_page(), f"http://127.0.0.1:{server.port}"
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    told = context.new_cdp_session(page)
    told.send("Performance.enable", {"timeDomain": "threadTicks"})  # others work on this machine, too
    before, busy, answering = _browser_times(told), server.times()["all"], _request_seconds(address)
    page.goto(address)
    _wait_until_seen(page, n_shapes)
    after = _browser_times(told)
    spent = {
        "server": server.times()["all"] - busy,
        "requests": _request_seconds(address) - answering,
        "script": after["ScriptDuration"] - before["ScriptDuration"],
        "all tasks": after["TaskDuration"] - before["TaskDuration"],
    }
    context.close()
    milliseconds = {column: 1000 * seconds for column, seconds in spent.items()}
    total = milliseconds["server"] + milliseconds["script"]
    return {**milliseconds, "server and script": total, "files and answers": len(asked)}


def _wait_until_seen(page: Page, n_shapes: int) -> None:
    """Wait for every picture in view, and for what is asked for after them."""
    if n_shapes:
        expect(page.locator(".card").first).to_be_visible()
        page.wait_for_function(
            "() => [...document.querySelectorAll('.card img[loading=eager]')].every((one) => one.complete)"
        )
    else:
        expect(page.get_by_role("heading", name="Nothing is here yet")).to_be_visible()
    page.wait_for_timeout(SETTLED)


def _browser_times(told: CDPSession) -> Cost:
    metrics = told.send("Performance.getMetrics")["metrics"]
    return {metric["name"]: metric["value"] for metric in metrics}


def _request_seconds(address: str) -> float:
    families = text_string_to_metric_families(httpx.get(f"{address}/metrics").text)
    samples = [sample for family in families for sample in family.samples]
    return sum(
        sample.value
        for sample in samples
        if sample.name == "faience_request_seconds_sum" and sample.labels["path"] != "/metrics"
    )


if __name__ == "__main__":
    print(table_of(rows()))
