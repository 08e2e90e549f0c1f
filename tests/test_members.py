"""The list of an archive's members: each once, each for one shape."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from index.errors import DamagedExport, StorageFull
from service.backup.members import Members
from service.backup.writing import Written

ONE, OTHER = Written(size=1, sha256="a"), Written(size=2, sha256="b")


@pytest.fixture
def members(tmp_path: Path) -> Iterator[Members]:
    with Members(tmp_path) as opened:
        yield opened


def test_members_keep_their_order(members: Members) -> None:
    for name in ("z", "a", "m"):
        members.add(name, ONE)
    assert [name for name, _ in members.all()] == ["z", "a", "m"]
    assert members.find("a") == ONE
    assert members.find("b") is None


def test_a_name_comes_once(members: Members) -> None:
    members.add("a", ONE)
    with pytest.raises(DamagedExport, match="'a' twice"):
        members.add("a", OTHER)


def test_a_file_belongs_to_one_shape(members: Members) -> None:
    members.add("files/uploads/u/0", OTHER)
    assert members.claim("uploads/u/0") == OTHER
    assert members.claim("uploads/u/1") is None
    with pytest.raises(DamagedExport, match="two shapes claim"):
        members.claim("uploads/u/0")


def test_what_nobody_claims_is_told(members: Members) -> None:
    members.add("library.json", ONE)
    members.add("tables/shapes.jsonl", ONE)
    for key in ("shapes/a/x", "shapes/a/y/z", "shapes/ab/x"):
        members.add(f"files/{key}", ONE)
    assert members.unclaimed() is not None
    members.claim_below("shapes/a/")
    assert members.unclaimed() == "files/shapes/ab/x"
    members.claim_below("shapes/ab/")
    assert members.unclaimed() is None


def test_a_full_disk_is_named(tmp_path: Path) -> None:
    def fill() -> None:
        with Members(tmp_path) as members:
            members._connection.execute("PRAGMA max_page_count = 1")  # SQLite takes it for its present size
            for number in range(10_000):
                members.add(str(number), ONE)

    with pytest.raises(StorageFull):
        fill()
