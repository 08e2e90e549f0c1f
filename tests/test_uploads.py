"""A body arrives whole and in time, or leaves nothing behind."""

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from service.http.connections import BoundedConnection
from soak.crowd import concurrent_uploads
from soak.cut import Way, cut_uploads, last_cut, seams
from soak.parcels import TEXTURED, kind_of, parcel
from soak.stalled import FIRST_PARCEL, PLACES, stalled_clients
from soak.target import Target, form
from soak.wire import connected, read_reply
from tests.fakes import coloured_triangle
from tests.problems import problem
from tests.serving import Serving, serving, settings_for

STEP = 150  # bytes between two cuts; around the seams of the form every byte is one


class Hasty(BoundedConnection):
    """A connection with little patience."""

    head_seconds = 2.0
    deaf_seconds = 2.0


@pytest.fixture
def service(tmp_path: Path) -> Iterator[Serving]:
    with serving(settings_for(tmp_path, workers=0)) as running:
        yield running


@pytest.fixture
def target(service: Serving) -> Target:
    return target_of(service)


@pytest.fixture
def hasty(tmp_path: Path) -> Iterator[Target]:
    settings = settings_for(tmp_path, workers=0, body_idle_seconds=2, body_seconds=4)
    with serving(settings, connection=Hasty) as running:
        yield target_of(running)


def target_of(running: Serving) -> Target:
    return Target(address=running.address, folder=running.library.settings.data_dir)


def test_an_upload_cut_anywhere_and_anyhow_leaves_nothing_and_can_be_sent_again(target: Target) -> None:
    assert kind_of(TEXTURED) == "obj"
    body = form(parcel(TEXTURED))
    offsets = sorted({*seams(body), *range(0, last_cut(body) + 1, STEP)})
    figures = cut_uploads(target, body, offsets)
    assert figures.cuts == len(Way) * len(offsets) > 200
    assert figures.again >= len(Way)
    assert figures.answers["short 400 incomplete_body"] == len(offsets)
    assert target.files() == set()


def test_the_last_cut_is_the_last_that_makes_a_form_incomplete(target: Target) -> None:
    body = form(parcel(TEXTURED))
    assert target.upload(body[: last_cut(body)]).status == 400
    assert target.upload(body[: last_cut(body) + 1]).status == 202


def test_twenty_stalled_clients_keep_nobody_from_working_and_are_let_go(hasty: Target) -> None:
    figures = stalled_clients(hasty, 20, requests=4, release_seconds=12)
    assert figures.stalled == dict.fromkeys(PLACES, 5) == figures.released
    assert figures.ratio < 50  # beside a few that wait for ever it would be endless; measured 1.5
    assert len(hasty.files()) == sum(len(parcel(number)) for number in sent_beside(requests=4))


def sent_beside(requests: int) -> range:
    """Return the numbers of the parcels that the working client sent."""
    return range(FIRST_PARCEL, FIRST_PARCEL + 2 * requests)


def test_two_hundred_uploads_at_once_become_one_shape_for_each_content(target: Target) -> None:
    figures = concurrent_uploads(target, 200, copies=4)
    assert (figures.sent, figures.contents) == (200, 50)
    assert figures.answers[202] == 50


def test_a_stalled_body_is_told_what_happened(hasty: Target) -> None:
    with connected(hasty.address) as connection:
        connection.sendall(hasty.upload_head("Content-Length: 9999") + form(parcel(TEXTURED))[:100])
        reply = read_reply(connection)
    assert (reply.status, reply.code) == (408, "slow_body")
    assert "100 bytes" in reply.json()["detail"]


def test_a_body_that_trickles_for_too_long_is_given_up(hasty: Target) -> None:
    stop = threading.Event()
    with connected(hasty.address) as connection:
        connection.sendall(hasty.upload_head("Content-Length: 9999999") + form(parcel(TEXTURED))[:100])

        def trickle() -> None:
            while not stop.wait(0.2):
                try:
                    connection.sendall(b"x")
                except OSError:
                    return

        feeder = threading.Thread(target=trickle)
        feeder.start()
        reply = read_reply(connection)
        stop.set()
        feeder.join()
    assert (reply.status, reply.code) == (408, "slow_body")
    assert hasty.files() == set()


def test_an_upload_that_would_eat_the_reserve_is_refused_and_reads_go_on(tmp_path: Path) -> None:
    with serving(settings_for(tmp_path, workers=0, reserve_bytes=2**60)) as running:
        problem(running.add({"a.ply": coloured_triangle()}, wait=0), 507, "storage_full")
        assert running.client.get("/v1/shapes").status_code == 200
        assert target_of(running).files() == set()


def test_a_disk_that_fills_up_during_an_upload_is_told_and_recovers(
    service: Serving, target: Target, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as broken:
        broken.setattr("service.intake.multipart._FilePart.add", full)
        problem(service.add({"a.ply": coloured_triangle()}, wait=0), 507, "storage_full")
    assert target.files() == set()
    assert service.add({"a.ply": coloured_triangle()}, wait=0).status_code == 202
