import threading
from concurrent.futures import ThreadPoolExecutor

from index.locks import SharedLock

SOON = 30.0  # seconds after which a test has failed


def test_readers_are_in_together() -> None:
    lock = SharedLock()
    together = threading.Barrier(3)

    def read() -> None:
        with lock.shared():
            together.wait(SOON)

    with ThreadPoolExecutor(3) as threads:
        for done in [threads.submit(read) for _ in range(3)]:
            done.result(SOON)


def test_a_writer_is_alone() -> None:
    lock = SharedLock()
    inside = [0, 0]  # readers, writers
    seen: set[tuple[int, int]] = set()
    counting = threading.Lock()

    def enter(kind: int, step: int) -> None:
        with counting:
            inside[kind] += step
            seen.add((inside[0], inside[1]))

    def work(kind: int) -> None:
        for _ in range(200):
            with lock.alone() if kind else lock.shared():
                enter(kind, 1)
                enter(kind, -1)

    with ThreadPoolExecutor(6) as threads:
        for done in [threads.submit(work, number % 2) for number in range(6)]:
            done.result(SOON)
    assert {writers for _, writers in seen} == {0, 1}
    assert all(readers == 0 for readers, writers in seen if writers)


def test_a_waiting_writer_goes_before_new_readers() -> None:
    lock = SharedLock()
    order: list[str] = []
    reading, release = threading.Event(), threading.Event()

    def hold() -> None:
        with lock.shared():
            reading.set()
            release.wait(SOON)

    def write() -> None:
        with lock.alone():
            order.append("writer")

    def read() -> None:
        with lock.shared():
            order.append("reader")

    holder, writer, reader = (threading.Thread(target=target) for target in (hold, write, read))
    holder.start()
    assert reading.wait(SOON)
    writer.start()
    while not lock._waiting_writers:  # the writer stands in the queue
        pass
    reader.start()
    release.set()
    for thread in (holder, writer, reader):
        thread.join(SOON)
    assert order == ["writer", "reader"]


def test_an_error_inside_lets_go() -> None:
    lock = SharedLock()
    for hold in (lock.shared, lock.alone):
        try:
            with hold():
                raise RuntimeError
        except RuntimeError:
            pass
    with lock.alone():
        pass
