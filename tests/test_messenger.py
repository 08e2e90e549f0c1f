"""Who asked to be told is told, signed, as often as it takes, also after a restart."""

import re
from pathlib import Path

import httpx2
import pytest

from index.deliveries import Deliveries
from index.revisions import now
from index.webhooks import Webhooks
from service.webhooks.sending import message, send
from service.webhooks.signing import signature
from soak.processes import free_port
from tests.fakes import coloured_triangle
from tests.listening import receiving
from tests.serving import serving, settings_for, wait_until

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL


def test_a_library_is_told_of_what_became_ready_and_of_what_failed(tmp_path: Path) -> None:
    with receiving() as receiver, serving(settings_for(tmp_path)) as running:
        _, secret = Webhooks(running.library.engine).add(receiver.url)
        good = running.add({"vase.ply": coloured_triangle()}, wait=60).json()
        bad = running.add({"pot.ply": b"fails" + coloured_triangle(1)}, wait=0)
        assert bad.status_code == 422  # refused in the reply: nobody has to be told
        wait_until(lambda: len(receiver.heard) == 1)
        (heard,) = receiver.heard
        assert heard.json["type"] == "shape.ready"
        assert heard.json["data"] == running.shape(good["id"])
        assert re.fullmatch(r"\d{4}-\d\d-\d\dT[\d:.]+Z", heard.json["timestamp"])
        signed = signature(
            secret, heard.headers["webhook-id"], int(heard.headers["webhook-timestamp"]), heard.body
        )
        assert heard.headers["webhook-signature"] == signed
        wait_until(lambda: Deliveries(running.library.engine).waiting() == 0)


def test_what_happened_while_nobody_listened_is_told_later_also_after_a_restart(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with receiving() as receiver:
        receiver.answers = [500, 302]  # a redirection is not followed
        with serving(settings_for(tmp_path)) as running:
            Webhooks(running.library.engine).add(receiver.url)
            running.add({"vase.ply": coloured_triangle()}, wait=60)
            wait_until(lambda: len(receiver.heard) == 1)
            wait_until(lambda: Webhooks(running.library.engine).known()[0].failures == 1)
        with serving(settings_for(tmp_path)) as running:
            wait_until(lambda: len(receiver.heard) == 3)
            wait_until(lambda: Deliveries(running.library.engine).waiting() == 0)
            assert Webhooks(running.library.engine).known()[0].failures == 0
    assert set(receiver.told) == {("shape.ready", "vase", receiver.told[0][2])}
    assert {heard.path for heard in receiver.heard} == {"/faience"}


def test_why_a_message_did_not_arrive_is_said_in_words() -> None:
    with httpx2.Client() as client:
        reason = send(client, f"http://127.0.0.1:{free_port()}", b"s", "msg_1", b"{}")
    assert reason is not None
    assert reason.startswith("ConnectError")


def test_a_message_says_what_when_and_about_which_shape() -> None:
    assert message("ping", now(), {"a": 1}).startswith(b'{"type": "ping", "timestamp": "')
