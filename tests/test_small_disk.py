"""A disk that others fill: refused, answered, emptied, recovered."""

from pathlib import Path

import pytest

from soak.small_disk import LATER, READY, WAITING, NoSmallDisk, run, small_disk

STILL = {"list": 200, "similar": 200, "thumbnail": 200, "remove": 204}
REFUSED = {"upload": 507, "upload after a removal": 507}


def test_a_full_disk_refuses_uploads_keeps_answering_is_emptied_and_recovers_by_itself(
    tmp_path: Path,
) -> None:
    try:
        with small_disk(tmp_path / "disk") as disk:
            figures = run(disk)
    except NoSmallDisk as error:
        pytest.skip(f"no small disk can be mounted: {error}")
    assert figures.full == STILL | REFUSED
    assert figures.restarted == STILL | REFUSED
    kept = [READY[0], *READY[3:], *WAITING, LATER]  # two were removed while the disk was full
    assert figures.states == {str(number): "ready" for number in kept}
