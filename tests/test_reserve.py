"""What is held back on the disk comes to the help of what makes room."""

import os
from pathlib import Path

import pytest

from index.errors import StorageFull
from service.reserve import LEAST, Reserve
from soak.small_disk import NoSmallDisk, small_disk

SIZE = 8 * LEAST


@pytest.fixture
def reserve(tmp_path: Path) -> Reserve:
    return Reserve(tmp_path / "reserve", SIZE)


def taken(folder: Path) -> int:
    """Return the bytes of the disk that files take, not what they say they hold."""
    return sum(512 * path.stat().st_blocks for path in folder.iterdir())


def test_the_space_is_really_taken(tmp_path: Path, reserve: Reserve) -> None:
    assert reserve.fill()
    assert taken(tmp_path) >= SIZE
    reserve.release()
    assert taken(tmp_path) == 0


def test_where_the_system_sets_nothing_aside_the_space_is_written(
    tmp_path: Path, reserve: Reserve, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delattr(os, "posix_fallocate", raising=False)
    assert reserve.fill()
    assert taken(tmp_path) >= SIZE


def test_what_is_held_stays_untouched_while_there_is_room(tmp_path: Path, reserve: Reserve) -> None:
    reserve.fill()
    before = (tmp_path / "reserve").stat().st_ino
    assert reserve.despite_full_disk(lambda: 3) == 3
    assert reserve.fill()
    assert (tmp_path / "reserve").stat().st_ino == before


def test_on_a_full_disk_the_reserve_makes_room_and_comes_back(tmp_path: Path, reserve: Reserve) -> None:
    reserve.fill()

    def act() -> str:
        if taken(tmp_path) > 0:
            raise StorageFull("full")
        return "done"

    assert reserve.despite_full_disk(act) == "done"
    assert taken(tmp_path) >= SIZE


def test_what_the_reserve_cannot_help_is_told_and_the_reserve_comes_back(
    tmp_path: Path, reserve: Reserve
) -> None:
    reserve.fill()

    def act() -> None:
        raise StorageFull("full")

    with pytest.raises(StorageFull):
        reserve.despite_full_disk(act)
    assert taken(tmp_path) >= SIZE


def test_on_a_disk_with_too_little_room_as_much_is_held_as_there_is(tmp_path: Path) -> None:
    try:
        with small_disk(tmp_path / "disk", 4 * LEAST) as disk:
            assert not Reserve(disk / "reserve", SIZE).fill()
            assert LEAST <= taken(disk) <= 4 * LEAST
    except NoSmallDisk as error:
        pytest.skip(f"no small disk can be mounted: {error}")
