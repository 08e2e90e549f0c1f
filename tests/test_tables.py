from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path

import pytest
from sqlalchemy.exc import IntegrityError, StatementError

from index.database import make_engine, reading, writing
from index.migrating import migrate
from index.tables import FileRow, VocabularyRow

MOMENT = datetime(2026, 5, 4, 23, 30, 1, 123_456, tzinfo=timezone(timedelta(hours=-5)))


def test_a_moment_comes_back_aware_and_in_utc(tmp_path: Path) -> None:
    engine = make_engine(f"sqlite:///{tmp_path / 'c.db'}")
    migrate(engine)
    with writing(engine) as session:
        session.add(VocabularyRow(id="v", fingerprint="f", data=b"", created_at=MOMENT))
    with reading(engine) as session:
        row = session.get(VocabularyRow, "v")
        assert row is not None
        assert row.created_at == MOMENT
        assert row.created_at.tzinfo is UTC
    engine.dispose()


def test_a_file_needs_its_shape(tmp_path: Path) -> None:
    engine = make_engine(f"sqlite:///{tmp_path / 'c.db'}")
    migrate(engine)
    orphan = FileRow(shape_id="nobody", position=0, name="a", key="k", size=1, sha256="x")
    with pytest.raises((IntegrityError, StatementError), match="FOREIGN KEY"), writing(engine) as session:
        session.add(orphan)
    engine.dispose()
