"""Dismissals: a pair has no order, is remembered once, and goes with its shapes."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import insert
from sqlalchemy.exc import IntegrityError

from index.database import writing
from index.dismissals import pair_of
from index.errors import BadCursor, DismissalNotFound, NotAPair, ShapeNotFound
from index.revisions import now
from index.tables import DismissalRow
from tests.catalogues import Opened, add_queued, open_catalogue

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Opened]:
    opened = open_catalogue(tmp_path)
    for shape_id in ("a", "b", "c", "d"):
        add_queued(opened, shape_id)
    yield opened
    opened.engine.dispose()


def pairs(opened: Opened) -> list[tuple[str, str]]:
    return [(found.one, found.other) for found in opened.catalogue.dismissals().items]


@given(st.text(), st.text())
def test_a_pair_has_no_order(one: str, other: str) -> None:
    assert pair_of(one, other) == pair_of(other, one) == tuple(sorted((one, other)))


def test_a_dismissal_is_remembered_once_with_its_first_moment(opened: Opened) -> None:
    first = opened.catalogue.dismiss("b", "a")
    assert (first.one, first.other) == ("a", "b")
    assert opened.catalogue.dismiss("a", "b") == first
    assert pairs(opened) == [("a", "b")]


def test_it_is_there_after_opening_anew(opened: Opened, tmp_path: Path) -> None:
    opened.catalogue.dismiss("c", "d")
    again = open_catalogue(tmp_path)
    assert pairs(again) == [("c", "d")]
    again.engine.dispose()


def test_it_can_be_taken_back_in_either_order_and_only_once(opened: Opened) -> None:
    opened.catalogue.dismiss("a", "b")
    opened.catalogue.undismiss("b", "a")
    assert pairs(opened) == []
    with pytest.raises(DismissalNotFound):
        opened.catalogue.undismiss("a", "b")


def test_two_shapes_that_exist_are_needed(opened: Opened) -> None:
    with pytest.raises(NotAPair):
        opened.catalogue.dismiss("a", "a")
    for pair in (("a", "nobody"), ("nobody", "a")):
        with pytest.raises(ShapeNotFound):
            opened.catalogue.dismiss(*pair)


def test_removing_a_shape_forgets_its_dismissals_alone(opened: Opened) -> None:
    for pair in (("a", "b"), ("b", "c"), ("c", "d")):
        opened.catalogue.dismiss(*pair)
    opened.catalogue.remove("b")
    assert pairs(opened) == [("c", "d")]


def test_pages_follow_each_other_in_the_order_of_ids(opened: Opened) -> None:
    wanted = [("a", "b"), ("a", "c"), ("a", "d"), ("b", "c"), ("c", "d")]
    for pair in reversed(wanted):
        opened.catalogue.dismiss(*pair)
    seen, cursor = [], None
    while True:
        page = opened.catalogue.dismissals(limit=2, cursor=cursor)
        seen += [(found.one, found.other) for found in page.items]
        cursor = page.next_cursor
        if cursor is None:
            break
    assert seen == wanted


@pytest.mark.parametrize(
    "cursor", ["", "é", "YWJj", "YmVmb3JlOjE6Mg=="]
)  # nothing, signs, "abc", "before:1:2"
def test_a_cursor_from_elsewhere_is_refused(opened: Opened, cursor: str) -> None:
    with pytest.raises(BadCursor):
        opened.catalogue.dismissals(cursor=cursor)


def test_those_of_some_shapes_are_found_by_either_side(opened: Opened) -> None:
    for pair in (("a", "b"), ("b", "c"), ("c", "d")):
        opened.catalogue.dismiss(*pair)
    assert opened.catalogue.dismissed_among(["b"]) == {("a", "b"), ("b", "c")}
    many = [f"x{number}" for number in range(1_000)]
    assert opened.catalogue.dismissed_among([*many, "d"]) == {("c", "d")}
    assert opened.catalogue.dismissed_among([]) == set()


def test_the_database_itself_refuses_a_pair_in_the_wrong_order(opened: Opened) -> None:
    with pytest.raises(IntegrityError), writing(opened.engine) as session:
        session.execute(insert(DismissalRow), {"one": "b", "other": "a", "created_at": now()})
