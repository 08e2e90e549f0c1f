"""What happens is noted with it, told oldest first, by one sender at a time, until it arrived."""

import threading
from collections import Counter
from datetime import datetime, timedelta
from pathlib import Path

import pytest

from index.deliveries import FORGOTTEN, LONGEST, Deliveries, Delivery
from index.jobs import MAX_ATTEMPTS
from index.revisions import now
from index.shapes import Status
from index.webhooks import Webhooks
from tests.catalogues import FINGERPRINT, HISTOGRAM, WORDS, Opened, add_queued, open_catalogue

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL


class Clock:
    """A clock that tests set."""

    def __init__(self) -> None:
        self.moment = now()

    def __call__(self) -> datetime:
        """Return the moment."""
        return self.moment

    def pass_by(self, time: timedelta) -> None:
        """Let time go by."""
        self.moment += time


@pytest.fixture
def opened(tmp_path: Path) -> Opened:
    return open_catalogue(tmp_path)


def settle(opened: Opened, shape_id: str, *, code: str | None = None) -> None:
    """Let a shape become ready, or fail."""
    add_queued(opened, shape_id)
    job = opened.queue.claim("worker", 60)
    assert job is not None
    if code is not None:
        opened.catalogue.record_failed(job, code=code, detail="words")
        return
    opened.catalogue.record_ready(
        job,
        facts={},
        fingerprint=FINGERPRINT,
        blocks=HISTOGRAM,
        quantised=WORDS,
        vocabulary_id=opened.vocabulary_id,
    )


def claimed(deliveries: Deliveries) -> Delivery:
    delivery = deliveries.claim(30)
    assert delivery is not None
    return delivery


def test_every_webhook_is_told_of_every_end_and_of_nothing_before_it_was_added(opened: Opened) -> None:
    settle(opened, "before")
    hooks = Webhooks(opened.engine)
    urls = {hooks.add(f"https://a.example/{n}")[0].url for n in range(2)}
    settle(opened, "good")
    settle(opened, "bad", code="empty")
    deliveries = Deliveries(opened.engine)
    assert deliveries.waiting() == 4
    told = []
    while (delivery := deliveries.claim(30)) is not None:
        told.append((delivery.shape_id, delivery.status, delivery.url))
        deliveries.told(delivery)
    assert set(told) == {
        (shape, status, url) for url in urls for shape, status in [("good", "ready"), ("bad", "failed")]
    }
    assert [shape for shape, _, _ in told] == ["good", "good", "bad", "bad"]
    assert deliveries.waiting() == 0


def test_a_shape_that_is_given_up_is_told_of(opened: Opened) -> None:
    Webhooks(opened.engine).add("https://a.example")
    add_queued(opened, "s")
    for _ in range(MAX_ATTEMPTS):
        assert opened.queue.claim("worker", -1) is not None
    assert opened.queue.claim("worker", 60) is None
    assert claimed(Deliveries(opened.engine)).status == Status.FAILED


def test_a_message_is_one_senders_until_its_lease_ends(opened: Opened) -> None:
    clock = Clock()
    deliveries = Deliveries(opened.engine, clock)
    Webhooks(opened.engine).add("https://a.example")
    settle(opened, "s")
    first = claimed(deliveries)
    assert deliveries.claim(30) is None
    clock.pass_by(timedelta(seconds=31))
    again = claimed(deliveries)
    assert again.id == first.id  # by which the receiver knows it
    deliveries.told(again)
    deliveries.told(first)  # late, and no matter
    assert deliveries.waiting() == 0


def test_many_senders_take_each_message_once(opened: Opened, tmp_path: Path) -> None:
    Webhooks(opened.engine).add("https://a.example")
    for number in range(40):
        settle(opened, f"s{number:02}")
    taken: Counter[int] = Counter()

    def send() -> None:
        mine = Deliveries(open_catalogue(tmp_path).engine)
        while (delivery := mine.claim(600)) is not None:
            taken[delivery.id] += 1

    senders = [threading.Thread(target=send) for _ in range(4)]
    for sender in senders:
        sender.start()
    for sender in senders:
        sender.join()
    assert set(taken.values()) == {1}
    assert len(taken) == 40


def test_a_webhook_that_fails_rests_longer_each_time_and_others_go_on(opened: Opened) -> None:
    clock, hooks = Clock(), Webhooks(opened.engine)
    deliveries = Deliveries(opened.engine, clock)
    broken, _ = hooks.add("https://broken.example")
    settle(opened, "s")
    rests: list[timedelta] = []
    for _ in range(14):
        deliveries.failed(claimed(deliveries), "answered 500")
        rested = hooks.known()[0].rests_until
        assert rested is not None
        rests.append(rested - clock.moment)
        assert deliveries.claim(30) is None
        clock.moment = rested
    assert rests == sorted(rests)
    assert rests[0] < timedelta(seconds=10) < rests[2]
    assert rests[-1] == LONGEST
    assert (hooks.known()[0].failures, hooks.known()[0].failure) == (14, "answered 500")
    clock.pass_by(-timedelta(minutes=1))  # while it rests
    hooks.add("https://well.example")
    settle(opened, "t")
    assert claimed(deliveries).url == "https://well.example"
    clock.pass_by(timedelta(hours=2))
    deliveries.told(claimed(deliveries))
    assert (hooks.known()[0].id, hooks.known()[0].failures, hooks.known()[0].rests_until) == (
        broken.id,
        0,
        None,
    )


def test_what_is_not_true_any_more_or_days_old_is_not_told(opened: Opened) -> None:
    clock = Clock()
    deliveries = Deliveries(opened.engine, clock)
    Webhooks(opened.engine).add("https://a.example")
    settle(opened, "failed-then-queued", code="empty")
    opened.catalogue.retry("failed-then-queued")
    assert deliveries.claim(30) is None
    opened.catalogue.remove("failed-then-queued")
    settle(opened, "removed")
    opened.catalogue.remove("removed")
    assert deliveries.waiting() == 0
    settle(opened, "old")
    clock.pass_by(FORGOTTEN + timedelta(minutes=1))
    assert deliveries.claim(30) is None
    assert deliveries.waiting() == 0


def test_a_removed_webhook_is_told_nothing(opened: Opened) -> None:
    hooks = Webhooks(opened.engine)
    hook, _ = hooks.add("https://a.example")
    settle(opened, "s")
    held = claimed(Deliveries(opened.engine))
    hooks.remove(hook.id)
    for end in (Deliveries(opened.engine).told, Deliveries(opened.engine).drop):
        end(held)
    Deliveries(opened.engine).failed(held, "answered 500")
    assert Deliveries(opened.engine).waiting() == 0
