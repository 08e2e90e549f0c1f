"""Each part says whether it is well, and one that hangs holds up nobody."""

import logging
import threading

import pytest

from service.watching.readiness import Check, NotWell, Readiness, ShuttingDown, Unready
from tests.serving import wait_until


def fails(error: Exception) -> None:
    raise error


def test_all_parts_are_named_and_those_of_others_do_not_matter() -> None:
    ready = Readiness([Check(name="one", run=lambda: None)], {"worker": lambda: "is none here"})
    assert ready.look() == {"one": "ok", "worker": "is none here"}


def test_the_part_that_is_not_well_is_named_with_its_reason_and_no_secret() -> None:
    checks = [
        Check(name="good", run=lambda: None),
        Check(name="files", run=lambda: fails(NotWell("cannot be written"))),
        Check(name="catalogue", run=lambda: fails(OSError("password=hunter2"))),
    ]
    with pytest.raises(Unready) as raised:
        Readiness(checks).look()
    parts = raised.value.members["parts"]
    assert parts["good"] == "ok"
    assert parts["files"] == "cannot be written"
    assert "hunter2" not in f"{parts} {raised.value}"
    assert "files cannot be written" in str(raised.value)


def test_a_part_that_hangs_is_named_in_time_and_asked_once() -> None:
    asked, release = [], threading.Event()

    def hang() -> None:
        asked.append(1)
        release.wait(60)

    ready = Readiness([Check(name="store", run=hang, seconds=0.01)], kept_seconds=0)
    for _ in range(3):
        with pytest.raises(Unready, match="store has not answered for"):
            ready.look()
    assert len(asked) == 1
    release.set()

    def well() -> bool:
        try:
            return ready.look() == {"store": "ok"}
        except Unready:
            return False

    wait_until(well)


def test_an_answer_holds_for_its_time() -> None:
    asked: list[int] = []
    check = Check(name="one", run=lambda: asked.append(1))
    kept, fresh = Readiness([check], kept_seconds=1e6), Readiness([check], kept_seconds=0)
    for _ in range(3):
        kept.look()
    assert len(asked) == 1
    for _ in range(3):
        fresh.look()
    assert len(asked) == 4


def test_shutting_down_is_said_at_once() -> None:
    ready = Readiness([Check(name="one", run=lambda: None)], kept_seconds=1e6)
    ready.look()
    ready.shutting_down = True
    with pytest.raises(ShuttingDown):
        ready.look()


def test_the_log_hears_of_changes_alone(caplog: pytest.LogCaptureFixture) -> None:
    words = ["cannot be written", "cannot be written", ""]

    def check() -> None:
        word = words.pop(0)
        if word:
            raise NotWell(word)

    ready = Readiness([Check(name="files", run=check)], kept_seconds=0)
    with caplog.at_level(logging.WARNING):
        for _ in range(2):
            with pytest.raises(Unready):
                ready.look()
        ready.look()
    assert caplog.messages == ["files cannot be written", "files is well again"]
