"""Lines of the log are whole, one each, and say what they are about."""

import json
import logging
import subprocess
import sys
import threading

import pytest

from service.watching.context import known, known_as
from service.watching.logs import JsonLines


def line_of(message: str, *args: object, **more: object) -> dict[str, object]:
    record = logging.makeLogRecord(
        {"name": "service.x", "levelno": 30, "levelname": "WARNING", "msg": message, "args": args, **more}
    )
    text = JsonLines().format(record)
    assert "\n" not in text
    line: dict[str, object] = json.loads(text)
    return line


def test_a_line_is_one_json_object_whatever_it_says() -> None:
    line = line_of("two\nlines, “quotes” and %s", '"more"')
    assert line["message"] == 'two\nlines, “quotes” and "more"'
    assert (line["level"], line["logger"]) == ("warning", "service.x")
    assert str(line["time"]).endswith("Z")


def test_ids_that_are_known_here_are_in_every_line() -> None:
    with known_as(request_id="r", trace_id=None):
        with known_as(job_id=7, shape_id="s"):
            line = line_of("x", more={"outcome": "ready"})
            assert {name: line[name] for name in ("request_id", "job_id", "shape_id", "outcome")} == {
                "request_id": "r",
                "job_id": 7,
                "shape_id": "s",
                "outcome": "ready",
            }
            assert "trace_id" not in line
        assert "job_id" not in line_of("x")
    assert known() == {}


def test_other_threads_know_nothing_of_it() -> None:
    seen: list[object] = []
    with known_as(request_id="r"):
        thread = threading.Thread(target=lambda: seen.append(dict(known())))
        thread.start()
        thread.join()
    assert seen == [{}]


def test_an_exception_is_told_within_its_line() -> None:
    try:
        raise ValueError("because")
    except ValueError:
        line = line_of("failed", exc_info=sys.exc_info())
    assert "ValueError: because" in str(line["error"])


@pytest.mark.parametrize(("kind", "start"), [("text", "20"), ("json", '{"time": "20')])
def test_the_kind_of_lines_is_a_setting(kind: str, start: str) -> None:
    script = (
        "import logging; from service.watching.logs import start_logging; "
        f"start_logging({kind!r}); logging.getLogger('a').info('b')"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    (line,) = done.stderr.splitlines()
    assert line.startswith(start)
