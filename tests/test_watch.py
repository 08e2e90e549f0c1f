"""A search tells its stages and how much it read, to whoever listens in its context."""

import contextlib
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from index import ranking
from index.ranking import rank
from index.searcher import Searcher
from index.vectors import SKETCHED, Vectors
from index.watch import Watch, stage, watched
from service.watching.metrics import Metrics
from service.watching.queries import QueriesSeen
from service.watching.spans import Spans
from tests.brute_force import add, make_blocks
from tests.catalogues import open_catalogue
from tests.layouts import byte_layout, clustered_rows

Compared = tuple[str, int, int, bool]


class Listener(Watch):
    """Keeps what it hears."""

    def __init__(self) -> None:
        self.stages: list[tuple[str, str]] = []
        self.searches: list[Compared] = []

    @contextlib.contextmanager
    def stage(self, name: str, method: str) -> Iterator[None]:
        """Keep it."""
        self.stages.append((name, method))
        yield

    def compared(self, method: str, rows: int, of: int, escalated: bool) -> None:
        """Keep it."""
        self.searches.append((method, rows, of, escalated))


def test_a_search_tells_its_stages_and_that_it_compared_all_of_a_small_library(tmp_path: Path) -> None:
    opened = open_catalogue(tmp_path)
    for number in range(5):
        add(opened, number)
    searcher = Searcher(opened.catalogue, tmp_path / "index")
    listener = Listener()
    with watched(listener):
        searcher.search("hks", make_blocks(98), 3)
    searcher.search("hks", make_blocks(98), 3)  # nobody listens
    assert listener.stages == [("catch_up", "hks"), ("rank", "hks")]
    assert listener.searches == [("hks", 5, 5, False)]
    opened.engine.dispose()


def test_each_loaded_index_says_what_it_shows(tmp_path: Path) -> None:
    opened = open_catalogue(tmp_path)
    add(opened, 1)
    searcher = Searcher(opened.catalogue, tmp_path / "index")
    assert searcher.revisions() == {}
    searcher.load("fused")
    assert searcher.revisions() == {"fused": opened.catalogue.revision()}
    add(opened, 2)
    assert searcher.revisions()["fused"] < opened.catalogue.revision()
    searcher.load("fused")
    assert searcher.revisions()["fused"] == opened.catalogue.revision()
    opened.engine.dispose()


def test_a_sketch_spares_most_rows_and_a_second_limit_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    layout = byte_layout(1, (3, 9, 5))
    rows = clustered_rows(layout, SKETCHED, 40)
    vectors = Vectors(layout)
    vectors.put([f"{number:05}" for number in range(len(rows))], rows)
    vectors.settle()
    listener = Listener()
    with watched(listener):
        rank(vectors, rows[0], 1)
        monkeypatch.setattr(ranking, "SECOND", 1)  # whatever is left beyond two rows is too much
        rank(vectors, rows[0], 5)
    first, second = listener.searches
    assert (first[2], first[3]) == (len(rows), False)
    assert 0 < first[1] < len(rows) / 2
    assert second[3]


def test_other_threads_do_not_listen() -> None:
    listener, heard = Listener(), []

    def elsewhere() -> None:
        with stage("rank", "hks"):
            heard.append(1)

    with watched(listener):
        thread = threading.Thread(target=elsewhere)
        thread.start()
        thread.join()
    assert heard
    assert listener.stages == []


def test_stages_and_shares_become_numbers() -> None:
    metrics = Metrics()
    seen = QueriesSeen(metrics, Spans())
    with contextlib.suppress(KeyError), seen.stage("rank", "fused"):
        raise KeyError
    seen.compared("fused", 30, 1000, True)
    seen.compared("fused", 0, 0, False)
    lines = metrics.text().decode().splitlines()
    assert 'faience_query_seconds_count{method="fused",stage="rank"} 1.0' in lines
    assert 'faience_query_compared_share_sum{method="fused"} 0.03' in lines
    assert 'faience_query_compared_share_count{method="fused"} 1.0' in lines
    assert 'faience_query_escalations_total{method="fused"} 1.0' in lines
