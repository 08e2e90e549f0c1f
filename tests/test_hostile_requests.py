"""Requests that no library writes get a problem with a code, at once, or are served; none meets a defect."""

import re
from collections.abc import Iterator

import pytest

from soak.wire import exchange
from tests.fakes import coloured_triangle
from tests.serving import Serving, serving, settings_for

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL

HOST = b"Host: localhost\r\n"
FORM = b"Content-Type: multipart/form-data; boundary=b0\r\n"
JSON = b"Content-Type: application/json\r\n"
CHUNKED = b"Transfer-Encoding: chunked\r\n"
FILE = b'Content-Disposition: form-data; name="files"; filename="a.ply"'
NINES = b"9" * 5000

Expected = set[tuple[int, str | None]]
OK: Expected = {(200, None)}
NO_HTTP: Expected = {(400, "bad_request")}
TOO_LONG: Expected = {(431, "headers_too_large")}
MULTIPART: Expected = {(400, "bad_multipart")}
INVALID: Expected = {(422, "invalid_request")}
WRONG_METHOD: Expected = {(405, "method_not_allowed")}
NO_SHAPE: Expected = {(404, "not_found")}
NO_FILE: Expected = {(404, "file_missing")}
BAD_NAME: Expected = {(422, "unsafe_reference")}
BAD_METADATA: Expected = {(422, "bad_metadata")}
METADATA = b'Content-Disposition: form-data; name="metadata"'


def ask(target: bytes, *headers: bytes, method: bytes = b"GET") -> bytes:
    return b"%s %s HTTP/1.1\r\n%s%s\r\n" % (
        method,
        target,
        HOST,
        b"".join(line + b"\r\n" for line in headers),
    )


def send(body: bytes, kind: bytes = FORM, target: bytes = b"/v1/shapes", method: bytes = b"POST") -> bytes:
    head = b"%s %s HTTP/1.1\r\n%s%s" % (method, target, HOST, kind)
    return b"%sContent-Length: %d\r\n\r\n%s" % (head, len(body), body)


def open_ended(headers: bytes, body: bytes) -> bytes:
    return b"POST /v1/shapes HTTP/1.1\r\n%s%s%s\r\n%s" % (HOST, FORM, headers, body)


def form(*parts: bytes) -> bytes:
    return b"".join(b"--b0\r\n%s\r\n" % part for part in parts) + b"--b0--\r\n"


def part(disposition: bytes = FILE, content: bytes = coloured_triangle()) -> bytes:
    return disposition + b"\r\n\r\n" + content


def named(name: bytes) -> bytes:
    return send(form(part(b'Content-Disposition: form-data; name="files"; filename="%s"' % name)))


def described(metadata: bytes) -> bytes:
    return send(form(part(METADATA, metadata), part()))


def change(body: bytes, kind: bytes = JSON) -> bytes:
    return send(body, kind, b"/v1/shapes/SHAPE", b"PATCH")


HEADS: dict[str, tuple[bytes, Expected]] = {
    "noise": (b"\x00\xff\x16\x03\x01" * 20 + b"\r\n\r\n", NO_HTTP),
    "no host": (b"GET /livez HTTP/1.1\r\n\r\n", NO_HTTP),
    "two hosts": (b"GET /livez HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n", NO_HTTP),
    "a host that is no address": (b"GET /v1/shapes HTTP/1.1\r\nHost: [::1\r\n\r\n", {(403, "foreign_host")}),
    "an origin that is none": (
        ask(b"/v1/search", b"Origin: http://[", method=b"POST"),
        {(403, "cross_origin")},
    ),
    "HTTP/1.0": (b"GET /livez HTTP/1.0\r\n\r\n", OK),
    "HTTP/2 by surprise": (b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", NO_SHAPE),
    "an upgrade": (ask(b"/livez", b"Connection: upgrade", b"Upgrade: websocket"), OK),
    "an endless address": (b"GET /" + b"a" * 2_000_000, TOO_LONG),
    "an endless header": (ask(b"/livez", b"X: " + b"y" * 2_000_000), TOO_LONG),
    "a hundred thousand headers": (ask(b"/livez", *(b"X-%d: y" % n for n in range(100_000))), TOO_LONG),
    "a header without a colon": (ask(b"/livez", b"no colon"), NO_HTTP),
    "a blank before the colon": (ask(b"/livez", b"Transfer-Encoding : chunked"), NO_HTTP),
    "NUL in a header": (ask(b"/livez", b"X: a\x00b"), NO_HTTP),
    "bytes above ASCII in the address": (ask("/v1/shapes/é".encode()), NO_HTTP),
    "HEAD": (ask(b"/v1/shapes", method=b"HEAD"), OK),
    "HEAD where only POST is": (ask(b"/v1/search", method=b"HEAD"), {(405, None)}),  # answered without a body
    "OPTIONS of all": (ask(b"*", method=b"OPTIONS"), NO_SHAPE),
    "TRACE": (ask(b"/v1/shapes", method=b"TRACE"), WRONG_METHOD),
    "CONNECT": (ask(b"localhost:80", method=b"CONNECT"), NO_SHAPE),
    "a method of 5000 letters": (ask(b"/v1/shapes", method=b"F" * 5000), WRONG_METHOD),
    "fifty questions in one breath": (ask(b"/livez") * 50, OK),
}
BODIES: dict[str, tuple[bytes, Expected]] = {
    "two lengths": (open_ended(b"Content-Length: 3\r\nContent-Length: 4\r\n", b"abc"), NO_HTTP),
    "a negative length": (open_ended(b"Content-Length: -3\r\n", b"abc"), NO_HTTP),
    "a length of twenty digits": (
        open_ended(b"Content-Length: %s\r\n" % NINES[:20], b""),
        {(413, "body_too_large")},
    ),
    "a length of 5000 digits": (open_ended(b"Content-Length: %s\r\n" % NINES, b""), NO_HTTP),
    "a length too short": (open_ended(b"Content-Length: 20\r\n", form(part())), {(400, "incomplete_body")}),
    "a length and chunks": (
        open_ended(b"Content-Length: 5\r\n" + CHUNKED, b"0\r\n\r\n"),
        NO_HTTP | {(400, "incomplete_body")},
    ),
    "a coding that nobody knows": (open_ended(b"Transfer-Encoding: gzip\r\n", b"abc"), NO_HTTP),
    "a chunk without measure": (open_ended(CHUNKED, b"F" * 40 + b"\r\nabc"), NO_HTTP),
    "a chunk that is none": (open_ended(CHUNKED, b"5\r\nab\r\nxyz\r\n"), NO_HTTP),
    "no form": (send(b"abc", b""), {(415, "not_multipart")}),
    "a boundary without measure": (send(b"", FORM[:-2] + b"b" * 2_000_000 + b"\r\n"), TOO_LONG),
    "a boundary above ASCII": (send(form(part()), FORM[:-2] + b"\xff\r\n"), MULTIPART),
    "a hundred thousand parts": (
        send(form(*(part(b'Content-Disposition: form-data; name="f%d"' % n, b"x") for n in range(100_000)))),
        {(413, "too_many_files")},
    ),
    "a part with endless headers": (
        send(form(part(b"\r\n".join(b"X-%d: y" % n for n in range(100_000))))),
        MULTIPART,
    ),
    "a part with a long header": (send(form(part(b"X: " + b"y" * 1_000_000))), MULTIPART),
    "a part without a name": (send(form(b"\r\nabc")), MULTIPART),
    "a file without a name": (
        send(form(part(b"Content-Disposition: form-data; name=\"files\"; filename*=UTF-8''b.ply"))),
        MULTIPART,
    ),
    "a compressed body": (send(b"\x1f\x8b" + b"x" * 99, FORM + b"Content-Encoding: gzip\r\n"), MULTIPART),
    "NUL in a file's name": (named(b"a\x00.ply"), BAD_NAME),
    "a file's name in Latin-1": (named(b"caf\xe9.ply"), MULTIPART),
    "a file's name of 2000 letters": (named(b"a" * 2000 + b".ply"), BAD_NAME),
    "a file's name of 5000 letters": (named(b"a" * 5000 + b".ply"), MULTIPART | BAD_NAME),
    "a file's name that climbs": (named(b"../../a.ply"), BAD_NAME),
    "a file's name from the root": (named(b"/etc/a.ply"), BAD_NAME),
    "metadata that are deep": (described(b'{"a":' * 10_000 + b"1" + b"}" * 10_000), BAD_METADATA),
    "metadata with NUL": (described(b'{"a": "\\u0000"}'), BAD_METADATA),
    "metadata with half a sign": (described(b'{"\\ud800": 1}'), BAD_METADATA),
    "metadata with an endless number": (described(b'{"a": %s}' % NINES), BAD_METADATA),
    "metadata with no number": (described(b'{"a": NaN}'), BAD_METADATA),
    "JSON that is deep": (change(b'{"metadata":' + b"[" * 100_000), NO_HTTP),
    "JSON in Latin-1": (change(b'{"name":"\xff"}'), NO_HTTP),
    "JSON with half a sign": (change(b'{"name":"\\ud800"}'), {(422, "bad_field")}),
    "JSON with an endless number": (change(b'{"metadata":{"a":%s}}' % NINES), NO_HTTP),
    "JSON of two million blanks": (change(b" " * 2_000_000), {(413, "body_too_large")}),
    "a form in place of JSON": (
        change(b"name=a", b"Content-Type: application/x-www-form-urlencoded\r\n"),
        INVALID,
    ),
}
ADDRESSES: dict[str, tuple[bytes, Expected]] = {
    "NUL": (ask(b"/v1/shapes/%00"), NO_SHAPE),
    "no UTF-8": (ask(b"/v1/shapes/%ff"), NO_SHAPE),
    "half a sign": (ask(b"/v1/shapes/%ED%A0%80"), NO_SHAPE),
    "a broken escape": (ask(b"/v1/shapes/%zz"), NO_SHAPE),
    "a file outside, escaped": (ask(b"/v1/shapes/SHAPE/files/..%2f..%2f..%2fcatalogue.sqlite3"), NO_FILE),
    "a file outside": (ask(b"/v1/shapes/SHAPE/files/../../../catalogue.sqlite3"), NO_FILE),
    "the program itself": (ask(b"/static/..%2fsettings.py"), NO_FILE),
    "double slashes": (ask(b"//v1//shapes"), NO_SHAPE),
    "another site": (ask(b"http://elsewhere.example/v1/shapes"), NO_SHAPE),
    "NUL to look for": (ask(b"/v1/shapes?q=%00"), OK),
    "no UTF-8 to look for": (ask(b"/v1/shapes?q=%ff%fe"), OK),
    "much to look for": (ask(b"/v1/shapes?q=" + b"a" * 9000), INVALID),
    "thousands of parameters": (ask(b"/v1/shapes?" + b"a=b&" * 3000), OK),
    "an endless limit": (ask(b"/v1/shapes?limit=" + NINES), INVALID),
    "a cursor of noise": (ask(b"/v1/shapes?cursor=%00%ff"), {(422, "bad_cursor")}),
    "weights that are deep": (
        ask(b"/v1/shapes/SHAPE/similar?weights=" + b"%7B%22a%22:" * 1000),
        {(422, "bad_weights")},
    ),
    "weights beyond numbers": (
        ask(b"/v1/shapes/SHAPE/similar?weights=log-hks:1e999"),
        {(422, "bad_weights")},
    ),
    "a wait for ever": (ask(b"/v1/shapes?wait=inf", method=b"POST"), INVALID),
}
RANGES: dict[str, tuple[bytes, Expected]] = {
    "500 parts": (b",".join(b"%d-%d" % (n, n) for n in range(0, 1000, 2)), OK | {(206, None)}),
    "the whole 2500 times": (b",".join([b"0-"] * 2500), OK | {(206, None)}),
    "the end": (b"-5", {(206, None)}),
    "beyond the end": (b"999999-", {(416, "range_not_satisfiable")}),
    "backwards": (b"5-2", NO_HTTP),
    "from 5000 digits": (NINES + b"-", NO_HTTP),
}
RANGE_CASES = {
    f"range: {name}": (ask(b"/v1/shapes/SHAPE/files/a.ply", b"Range: bytes=" + value), expected)
    for name, (value, expected) in RANGES.items()
}
CASES = HEADS | BODIES | ADDRESSES | RANGE_CASES


@pytest.fixture(scope="module")
def service(database: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    with serving(settings_for(tmp_path_factory.mktemp("library"), workers=1)) as running:
        yield running


@pytest.fixture(scope="module")
def shape_id(database: str, service: Serving) -> bytes:
    shape: dict[str, str] = service.add({"a.ply": coloured_triangle()}).json()
    return shape["id"].encode()


@pytest.mark.parametrize(("request_", "expected"), CASES.values(), ids=CASES)
def test_it_has_its_answer(
    service: Serving,
    shape_id: bytes,
    caplog: pytest.LogCaptureFixture,
    request_: bytes,
    expected: Expected,
) -> None:
    before = service.client.get("/v1/shapes").json()
    reply = exchange(service.address, request_.replace(b"SHAPE", shape_id))
    assert (reply.status, reply.code if reply.body else None) in expected, reply
    assert not [record for record in caplog.records if record.exc_info]  # nothing of it was a surprise
    assert not re.search(rb"Traceback|/site-packages/", reply.body)
    assert service.client.get("/v1/shapes").json() == before


def test_a_length_that_waits_is_told_to_go_on(service: Serving, shape_id: bytes) -> None:
    body = b'{"name": "after all"}'
    head = b"PATCH /v1/shapes/%s HTTP/1.1\r\n%s%sExpect: 100-continue\r\n" % (shape_id, HOST, JSON)
    reply = exchange(service.address, b"%sContent-Length: %d\r\n\r\n%s" % (head, len(body), body))
    assert reply.status == 200
    assert reply.json()["name"] == "after all"
