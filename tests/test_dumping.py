"""A dump shows one moment, without leases, and without what refers to what is left out."""

from pathlib import Path
from typing import Any

import pytest

from index.dumping import Moment, one_moment
from tests.catalogues import Opened, add_queued, add_ready, open_catalogue

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL


def dumped(moment: Moment, but: tuple[str, ...] = ()) -> dict[str, list[dict[str, Any]]]:
    return {name: list(rows) for name, rows in moment.tables(but)}


def filled(folder: Path) -> Opened:
    opened = open_catalogue(folder)
    for shape_id in ("one", "two"):
        add_ready(opened, shape_id)
    add_queued(opened, "three")
    return opened


def test_later_changes_are_not_seen(tmp_path: Path) -> None:
    opened = filled(tmp_path)
    with one_moment(opened.engine) as moment:
        counts = moment.counts()
        opened.catalogue.remove("one")
        add_queued(opened, "four")
        assert [shape.id for shape in moment.shapes()] == ["one", "three", "two"]
        assert {name: len(rows) for name, rows in dumped(moment).items()} == counts
    with one_moment(opened.engine) as moment:
        assert [shape.id for shape in moment.shapes()] == ["four", "three", "two"]
    opened.engine.dispose()


def test_shapes_come_with_their_files_and_in_batches(tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.setattr("index.dumping._AT_ONCE", 2)
    opened = filled(tmp_path)
    with one_moment(opened.engine) as moment:
        shapes = list(moment.shapes())
        assert [(shape.id, shape.ready) for shape in shapes] == [
            ("one", True),
            ("three", False),
            ("two", True),
        ]
        for shape in shapes:
            kept = opened.catalogue.get(shape.id)
            assert (shape.files, shape.revision) == (kept.files, kept.revision)
    opened.engine.dispose()


def test_a_job_is_free_and_its_shape_waits(tmp_path: Path) -> None:
    opened = filled(tmp_path)
    opened.queue.claim("somebody", 60)
    with one_moment(opened.engine) as moment:
        tables = dumped(moment)
    (job,) = tables["jobs"]
    free = {"attempts": 0, "lease_until": None, "claimed_at": None, "worker": None, "token": None}
    assert job == {
        "id": job["id"],
        "shape_id": "three",
        "queued_at": job["queued_at"],
        "fingerprint": None,
        **free,
    }
    assert {row["id"]: row["status"] for row in tables["shapes"]}["three"] == "queued"
    opened.engine.dispose()


def test_what_refers_to_a_shape_is_left_out_with_it(tmp_path: Path) -> None:
    opened = filled(tmp_path)
    with one_moment(opened.engine) as moment:
        whole, part = dumped(moment), dumped(moment, but=("one", "three"))
    for name in ("shapes", "files", "jobs", "plain_blocks", "quantised_blocks"):
        key = "id" if name == "shapes" else "shape_id"
        assert part[name] == [row for row in whole[name] if row[key] == "two"]
        assert len(whole[name]) > len(part[name])
    assert part["vocabularies"] == whole["vocabularies"]
    assert part["state"] == whole["state"]
    opened.engine.dispose()
