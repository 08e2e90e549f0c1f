"""What a program could not have written is found before anybody asks for it."""

from collections.abc import Callable
from pathlib import Path

import pytest
from sqlalchemy import delete, text, update
from sqlalchemy.orm import Session

from index.database import reading, writing
from index.errors import DamagedExport
from index.soundness import check_sound
from index.tables import PlainBlockRow, QuantisedBlockRow, ShapeRow, StateRow, TombstoneRow, VocabularyRow
from tests.catalogues import add_queued, add_ready, open_catalogue

Spoil = Callable[[Session], object]
ONE = QuantisedBlockRow.shape_id == "one"

SPOILT: dict[str, tuple[Spoil, str]] = {
    "no state": (lambda session: session.execute(delete(StateRow)), "must have one row"),
    "another state": (lambda session: session.execute(update(StateRow).values(id=2)), "must have one row"),
    "an old revision": (lambda session: session.execute(update(StateRow).values(revision=0)), "older than"),
    "a late grave": (
        lambda session: session.add(TombstoneRow(shape_id="gone", revision=10**6)),
        "older than",
    ),
    "an unknown status": (lambda session: session.execute(update(ShapeRow).values(status="x")), "state 'x'"),
    "metadata that is a list": (
        lambda session: session.execute(text("UPDATE shapes SET metadata = '[]'")),
        "JSON objects",
    ),
    "facts that are text": (
        lambda session: session.execute(text("UPDATE shapes SET facts = '\"x\"'")),
        "JSON objects",
    ),
    "no vocabulary": (lambda session: session.execute(update(VocabularyRow).values(data=b"")), "be read"),
    "no block": (lambda session: session.execute(update(PlainBlockRow).values(data=b"")), "is damaged"),
    "infinite words": (
        lambda session: session.execute(
            update(QuantisedBlockRow).values(data=b"\0\1\0\0\0" + b"\0\0\x80\x7f")
        ),
        "is damaged",
    ),
    "a block that claims much": (
        lambda session: session.execute(update(PlainBlockRow).values(data=b"\1\xff\xff\xff\xff")),
        "is damaged",
    ),
    "a block of another length": (
        lambda session: session.execute(
            update(QuantisedBlockRow).values(data=b"\0\1\0\0\0" + bytes(4)).where(ONE)
        ),
        "length",
    ),
}


def test_what_the_program_wrote_is_sound(tmp_path: Path) -> None:
    opened = open_catalogue(tmp_path)
    for shape_id in ("one", "two"):
        add_ready(opened, shape_id)
    add_queued(opened, "three")
    opened.catalogue.remove("two")
    with reading(opened.engine) as session:
        check_sound(session)
    opened.engine.dispose()


@pytest.mark.parametrize("case", SPOILT)
def test_what_it_did_not_write_is_told(tmp_path: Path, case: str) -> None:
    opened = open_catalogue(tmp_path)
    for shape_id in ("one", "two"):
        add_ready(opened, shape_id)
    spoil, reason = SPOILT[case]
    with writing(opened.engine) as session:
        spoil(session)
    with reading(opened.engine) as session, pytest.raises(DamagedExport, match=reason):
        check_sound(session)
    opened.engine.dispose()
