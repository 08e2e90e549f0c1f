from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from index.errors import BadCursor, ShapeNotFound
from index.shapes import Status
from tests.catalogues import Opened, add_queued, add_ready, open_catalogue

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Opened]:
    opened = open_catalogue(tmp_path)
    yield opened
    opened.engine.dispose()


def found(opened: Opened, q: str) -> set[str]:
    return {shape.id for shape in opened.catalogue.list(q=q).items}


def test_an_unknown_id_is_named(opened: Opened) -> None:
    with pytest.raises(ShapeNotFound, match="'nobody'"):
        opened.catalogue.get("nobody")


def test_many_are_found_by_id_and_unknown_ones_left_out(opened: Opened) -> None:
    for number in range(3):
        add_queued(opened, f"s{number}")
    wanted = ["s2", "none", "s0", *(f"x{number}" for number in range(2_000))]
    assert opened.catalogue.get_many(wanted).keys() == {"s0", "s2"}


def test_pages_run_from_the_newest_to_the_oldest(opened: Opened) -> None:
    for number in range(5):
        add_queued(opened, f"s{number}")
    seen, cursor = [], None
    while True:
        page = opened.catalogue.list(limit=2, cursor=cursor)
        seen.append([shape.id for shape in page.items])
        cursor = page.next_cursor
        if cursor is None:
            break
    assert seen == [["s4", "s3"], ["s2", "s1"], ["s0"]]
    assert opened.catalogue.list(limit=5).next_cursor is None


def test_pages_stay_in_step_while_shapes_come_and_go(opened: Opened) -> None:
    for number in range(6):
        add_queued(opened, f"s{number}")
    first = opened.catalogue.list(limit=2)
    add_queued(opened, "new")
    opened.catalogue.remove("s4")  # the one that the cursor points behind
    opened.catalogue.update("s0", name="renamed")
    second = opened.catalogue.list(limit=4, cursor=first.next_cursor)
    assert [shape.id for shape in second.items] == ["s3", "s2", "s1", "s0"]


@given(cursor=st.text(max_size=30))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])  # nothing is changed
def test_any_other_text_is_not_a_cursor(opened: Opened, cursor: str) -> None:
    with pytest.raises(BadCursor):
        opened.catalogue.list(cursor=cursor)


@pytest.mark.parametrize(
    "text", ["YmVmb3JlOi0x", "YWZ0ZXI6MQ==", "YmVmb3JlOjk5OTk5OTk5OTk5OTk5OTk5OTk5OTk5OTk5OTk5OTk5"]
)
def test_cursors_with_other_words_or_numbers_are_refused(opened: Opened, text: str) -> None:
    with pytest.raises(BadCursor):
        opened.catalogue.list(cursor=text)


def test_shapes_are_found_by_name_and_metadata_values(opened: Opened) -> None:
    add_queued(opened, "a", maker="Della ROBBIA", inner={"years": [1525, None]}, key="Straße")
    add_queued(opened, "b", other="nothing")
    assert found(opened, "robbia") == {"a"}
    assert found(opened, "1525") == {"a"}
    assert found(opened, "STRASSE") == {"a"}
    assert found(opened, "SHAPE B") == {"b"}
    assert found(opened, "maker") == set()  # keys are not values
    assert found(opened, "None") == set()
    assert found(opened, "") == {"a", "b"}


def test_signs_of_the_pattern_language_mean_themselves(opened: Opened) -> None:
    for shape_id, text in (("percent", "50%off"), ("under", "a_b"), ("slash", "c/d"), ("back", "e\\f")):
        add_queued(opened, shape_id, text=text)
    add_queued(opened, "plain", text="50 off, a-b")
    assert found(opened, "%") == {"percent"}
    assert found(opened, "_") == {"under"}
    assert found(opened, "/") == {"slash"}
    assert found(opened, "\\") == {"back"}
    assert found(opened, "0%o") == {"percent"}
    assert found(opened, "5_%") == set()


def test_text_that_no_database_accepts_finds_nothing_and_breaks_nothing(opened: Opened) -> None:
    add_queued(opened, "a", text="half \ud800 a pair, and \0")
    assert found(opened, "\ud801 x") == set()
    assert found(opened, "half") == {"a"}


@pytest.mark.parametrize("sign", ["%", "𝄞", "a"])
def test_a_filter_of_any_length_is_answered(opened: Opened, sign: str) -> None:
    add_queued(opened, "a", text=sign * 11_000)
    assert found(opened, sign * 10_999) == {"a"}
    assert found(opened, sign * 100_000) == set()


def test_a_renamed_shape_is_found_by_its_new_name_alone(opened: Opened) -> None:
    add_queued(opened, "a", tag="old tag")
    opened.catalogue.update("a", name="Éclair", metadata={"tag": "fresh"})
    assert found(opened, "shape") == found(opened, "old") == set()
    assert found(opened, "éclair") == found(opened, "FRESH") == {"a"}


def test_shapes_are_filtered_and_counted_by_status(opened: Opened) -> None:
    add_ready(opened, "a")
    add_ready(opened, "b")
    add_queued(opened, "c")
    assert [shape.id for shape in opened.catalogue.list(status=Status.READY).items] == ["b", "a"]
    assert opened.catalogue.list(status=Status.FAILED).items == ()
    assert opened.catalogue.counts() == {
        Status.QUEUED: 1,
        Status.PROCESSING: 0,
        Status.READY: 2,
        Status.FAILED: 0,
    }


def test_file_keys_are_those_of_all_shapes(opened: Opened) -> None:
    add_queued(opened, "a")
    add_queued(opened, "b")
    opened.catalogue.remove("a")
    assert opened.catalogue.file_keys() == {"shapes/b/files/0"}
