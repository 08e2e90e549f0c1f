"""Tags find shapes, whatever else their metadata holds."""

from collections.abc import Iterator
from datetime import datetime
from pathlib import Path

import pytest
from sqlalchemy import MetaData, Table, insert, select

from index.database import make_engine, reading
from index.errors import BadCursor
from index.migrating import migrate
from index.shapes import Status
from index.tables import TagRow
from index.tags import LONGEST, MOST, tags_of
from tests.catalogues import Opened, add_queued, open_catalogue

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL


NOON = datetime(2026, 3, 1, 12)  # noqa: DTZ001 - databases hold UTC without saying so


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Opened]:
    opened = open_catalogue(tmp_path)
    yield opened
    opened.engine.dispose()


def found(opened: Opened, *tags: str) -> set[str]:
    return {shape.id for shape in opened.catalogue.list(tags=tags).items}


def used(opened: Opened, q: str | None = None) -> list[tuple[str, int]]:
    return [(tag.name, tag.shapes) for tag in opened.catalogue.tags(q=q).items]


@pytest.mark.parametrize(
    ("metadata", "expected"),
    [
        ({}, {}),
        ({"tags": "vase"}, {"vase": "vase"}),
        ({"tags": ["Vase", "vase ", " red  figure"]}, {"vase": "Vase", "red figure": "red figure"}),
        ({"tags": ["", "  ", 3, None, ["vase"]]}, {}),
        ({"tags": {"vase": True}}, {}),
        ({"tags": ["x" * LONGEST, "x" * (LONGEST + 1)]}, {"x" * LONGEST: "x" * LONGEST}),
        ({"Tags": ["vase"]}, {}),
    ],
)
def test_tags_are_words_of_the_metadata(metadata: dict[str, object], expected: dict[str, str]) -> None:
    assert tags_of(metadata) == expected


def test_signs_that_no_database_takes_are_replaced(opened: Opened) -> None:
    add_queued(opened, "a", tags=["half \ud800", "nul\0l"])
    assert used(opened) == [("half ?", 1), ("nul l", 1)]


def test_the_step_that_fills_tags_takes_any_text(tmp_path: Path) -> None:
    engine = make_engine(f"sqlite:///{tmp_path / 'earlier.db'}")
    migrate(engine, "0003")
    with engine.begin() as connection:
        shapes = Table("shapes", MetaData(), autoload_with=connection)
        wanted: dict[str, object] = {
            "id": "a",
            "name": "a",
            "status": "ready",
            "sha256": "x",
            "searchable": "",
        }
        wanted |= {"created_at": NOON, "updated_at": NOON, "revision": 1, "sequence": 1}
        tags = {"tags": ["half \ud800", "Vase"]}
        connection.execute(insert(shapes), {**wanted, "allow_untextured": False, "metadata": tags})
    migrate(engine)
    with reading(engine) as session:
        found = session.execute(select(TagRow.folded, TagRow.shown).order_by(TagRow.folded)).all()
        assert [tuple(row) for row in found] == [("half ?", "half ?"), ("vase", "Vase")]
    engine.dispose()


def test_a_shape_has_so_many_tags_and_no_more() -> None:
    assert len(tags_of({"tags": [f"tag {number}" for number in range(MOST + 5)]})) == MOST


def test_shapes_are_found_by_all_of_their_tags(opened: Opened) -> None:
    add_queued(opened, "a", tags=["vase", "red figure"])
    add_queued(opened, "b", tags="Vase")
    add_queued(opened, "c", tags=[], note="vase")
    assert found(opened, "vase") == found(opened, " VASE") == {"a", "b"}
    assert found(opened, "vase", "Red  Figure") == {"a"}
    assert found(opened, "vas") == found(opened, "%") == set()
    assert found(opened) == {"a", "b", "c"}


def test_tags_follow_the_metadata(opened: Opened) -> None:
    add_queued(opened, "a", tags=["vase", "old"])
    opened.catalogue.update("a", metadata={"tags": ["vase", "new"]})
    assert used(opened) == [("new", 1), ("vase", 1)]
    opened.catalogue.update("a", name="renamed")
    assert found(opened, "new") == {"a"}
    opened.catalogue.remove("a")
    assert used(opened) == []


def test_the_most_used_come_first_page_by_page(opened: Opened) -> None:
    for number in range(5):
        add_queued(opened, f"s{number}", tags=[f"t{place}" for place in range(number + 1)])
    pages, cursor = [], None
    while True:
        page = opened.catalogue.tags(limit=2, cursor=cursor)
        pages.append([(tag.name, tag.shapes) for tag in page.items])
        cursor = page.next_cursor
        if cursor is None:
            break
    assert pages == [[("t0", 5), ("t1", 4)], [("t2", 3), ("t3", 2)], [("t4", 1)]]


def test_tags_are_found_by_how_they_begin(opened: Opened) -> None:
    add_queued(opened, "a", tags=["Vase", "vane", "urn", "100%"])
    assert used(opened, "VA") == [("vane", 1), ("Vase", 1)]
    assert used(opened, "100%") == [("100%", 1)]
    assert used(opened, "%") == []


@pytest.mark.parametrize("cursor", ["", "x", "dGFnOi0x", "YmVmb3JlOjE=", "\u00e9"])
def test_a_cursor_from_elsewhere_is_refused(opened: Opened, cursor: str) -> None:
    with pytest.raises(BadCursor):
        opened.catalogue.tags(cursor=cursor)


def test_counts_take_the_filters_of_the_list(opened: Opened) -> None:
    add_queued(opened, "a", tags=["vase"])
    add_queued(opened, "b", tags=["vase"], room="north")
    opened.queue.claim("w", 60)
    counts = opened.catalogue.counts(tags=["vase"])
    assert (counts[Status.QUEUED], counts[Status.PROCESSING], counts[Status.READY]) == (1, 1, 0)
    assert opened.catalogue.counts(q="north")[Status.QUEUED] == 1
    assert sum(opened.catalogue.counts(q="north", tags=["urn"]).values()) == 0
