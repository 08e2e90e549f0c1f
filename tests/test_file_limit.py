"""The service takes the open files that it needs, and knows how many it has."""

import resource
from collections.abc import Iterator

import pytest

from service.file_limit import WANTED, file_limit, raise_file_limit


@pytest.fixture(autouse=True)
def limit_as_before() -> Iterator[None]:
    before = resource.getrlimit(resource.RLIMIT_NOFILE)
    yield
    resource.setrlimit(resource.RLIMIT_NOFILE, before)


def test_a_low_limit_is_raised_as_far_as_the_system_allows() -> None:
    _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (512, hard))
    assert file_limit() == 512
    raise_file_limit()
    assert file_limit() == (WANTED if hard == resource.RLIM_INFINITY else min(WANTED, hard))


def test_a_high_limit_stays() -> None:
    before = file_limit()
    raise_file_limit()
    assert file_limit() >= before
