import errno

import pytest

from index.errors import StorageFull
from index.full_disk import full_disk_named


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT])
def test_no_space_and_over_quota_are_named(number: int) -> None:
    with pytest.raises(StorageFull), full_disk_named():
        raise OSError(number, "told by the system")


def test_other_failures_stay_what_they_are() -> None:
    with pytest.raises(PermissionError), full_disk_named():
        raise PermissionError(errno.EACCES, "not yours")
