from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy import bindparam, select
from sqlalchemy.dialects import postgresql
from sqlalchemy.exc import OperationalError

from index.database import looking
from index.prepared import Prepared, PreparedLists, listed
from index.tables import ShapeRow
from tests.catalogues import Opened, add_ready, open_catalogue
from tests.databases import only_on_sqlite

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL

SHAPES = ShapeRow.__table__.c
ONE = select(SHAPES.name, SHAPES.created_at, SHAPES["metadata"], SHAPES.allow_untextured).where(
    SHAPES.id == bindparam("shape_id")
)


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Opened]:
    opened = open_catalogue(tmp_path)
    yield opened
    opened.engine.dispose()


def test_rows_hold_what_the_types_of_the_table_say(opened: Opened) -> None:
    shape = add_ready(opened, "a")
    with looking(opened.engine) as cursor:
        (row,) = Prepared(ONE, opened.engine.dialect).rows(cursor, {"shape_id": "a"})
        assert Prepared(ONE, opened.engine.dialect).rows(cursor, {"shape_id": "b"}) == []
    assert row == [shape.name, shape.created_at, shape.metadata, shape.allow_untextured]


def test_lists_of_any_length_are_looked_for_beside_other_values(opened: Opened) -> None:
    for shape_id in ("a", "b", "c"):
        add_ready(opened, shape_id)
    lists = PreparedLists(
        lambda length: (
            select(SHAPES.id)
            .where(SHAPES.id.in_([bindparam(name) for name in listed(length)]), SHAPES.id != bindparam("but"))
            .order_by(SHAPES.id)
        ),
        opened.engine,
    )
    with looking(opened.engine) as cursor:
        for some in (["c", "b", "a"], ["b", "unknown"], ["a"], [], ["a", "c"]):
            found = lists.rows(cursor, {"but": "a"}, some)
            assert found == [[shape_id] for shape_id in sorted({*some} - {"a", "unknown"})]


def test_a_transaction_sees_one_moment(opened: Opened) -> None:
    one = Prepared(ONE, opened.engine.dialect)
    with looking(opened.engine) as cursor:
        assert one.rows(cursor, {"shape_id": "a"}) == []
        add_ready(opened, "a")
        assert one.rows(cursor, {"shape_id": "a"}) == []
    with looking(opened.engine) as cursor:
        assert len(one.rows(cursor, {"shape_id": "a"})) == 1


@only_on_sqlite
def test_failures_have_the_names_that_they_have_elsewhere(opened: Opened) -> None:
    with pytest.raises(OperationalError, match="no such table"), looking(opened.engine) as cursor:
        cursor.execute("SELECT 1 FROM nowhere")
    with looking(opened.engine) as cursor:  # the connection is as good as before
        assert Prepared(ONE, opened.engine.dialect).rows(cursor, {"shape_id": "a"}) == []


def test_drivers_that_take_names_are_given_names() -> None:
    class Cursor:
        def execute(self, sql: str, values: object) -> None:
            self.sent = sql, values

        def fetchall(self) -> list[tuple[object, ...]]:
            return []

    cursor = Cursor()
    dialect = postgresql.dialect()  # type: ignore[no-untyped-call] # SQLAlchemy's
    Prepared(ONE, dialect).rows(cursor, {"shape_id": "a"})  # type: ignore[arg-type] # two methods do
    assert cursor.sent[1] == {"shape_id": "a"}
    assert "%(shape_id)s" in cursor.sent[0]
