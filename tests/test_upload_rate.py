"""One key sends so many meshes a minute, whatever the others send."""

import time

import pytest

from service.http.upload_rate import TooManyUploads, UploadRate


def refused(rate: UploadRate, identity: str) -> int:
    """Return the seconds that a refused upload is told to wait."""
    with pytest.raises(TooManyUploads, match="uploads a minute") as refusal:
        rate.count(identity)
    return int(refusal.value.headers["Retry-After"])


def test_each_key_has_its_own_minute() -> None:
    rate = UploadRate(3)
    for identity in ("first", "second"):
        for _ in range(3):
            rate.count(identity)
        assert 1 <= refused(rate, identity) <= 60


def test_after_the_seconds_told_the_next_one_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = time.time()
    monkeypatch.setattr(time, "time", lambda: clock)
    rate = UploadRate(2)
    rate.count("first")
    clock += 20
    rate.count("first")
    wait = refused(rate, "first")
    assert wait == 40  # when the first of the two is a minute old
    clock += wait - 1
    assert refused(rate, "first") == 1
    clock += 1.001
    rate.count("first")
    refused(rate, "first")  # the second one's minute is not over: the window moves


def test_refused_uploads_do_not_count(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = time.time()
    monkeypatch.setattr(time, "time", lambda: clock)
    rate = UploadRate(1)
    rate.count("first")
    for _ in range(50):
        clock += 1
        refused(rate, "first")
    clock += 10.001
    rate.count("first")


def test_zero_lets_all_in() -> None:
    rate = UploadRate(0)
    for _ in range(2000):
        rate.count("first")
