"""A form arrives whole, or is refused."""

import hashlib
from collections.abc import Sequence
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.intake.multipart import (
    BadMultipart,
    FieldTooLong,
    FormLimits,
    FormReceiver,
    IncompleteBody,
    NotMultipart,
    TooManyFiles,
)
from worker.errors import MeshError

LIMITS = FormLimits(files=3, field_bytes=100)
TYPE = "multipart/form-data; boundary=b0"
Part = tuple[str, str | None, bytes]  # field, file name, content


def form(parts: Sequence[Part], end: bytes = b"--b0--\r\n") -> bytes:
    body = b""
    for field, name, content in parts:
        disposition = f'form-data; name="{field}"' + (f'; filename="{name}"' if name is not None else "")
        body += f"--b0\r\nContent-Disposition: {disposition}\r\n\r\n".encode() + content + b"\r\n"
    return body + end


def receive(folder: Path, body: bytes, piece: int = 1000, limits: FormLimits = LIMITS) -> FormReceiver:
    receiver = FormReceiver(TYPE, folder, limits)
    try:
        for start in range(0, len(body), piece):
            receiver.write(body[start : start + piece])
        receiver.finish()
    finally:
        receiver.close()
    return receiver


@given(contents=st.lists(st.binary(max_size=300), min_size=1, max_size=3), piece=st.integers(1, 50))
def test_files_arrive_byte_for_byte_however_the_body_is_cut_into_pieces(
    tmp_path_factory: pytest.TempPathFactory, contents: list[bytes], piece: int
) -> None:
    parts = [("files", f"a/{i}.ply", content) for i, content in enumerate(contents)]
    received = receive(tmp_path_factory.mktemp("form"), form(parts), piece)
    assert [file.path.read_bytes() for file in received.files] == contents
    assert [file.name for file in received.files] == [name for _, name, _ in parts]
    assert [file.sha256 for file in received.files] == [hashlib.sha256(c).hexdigest() for c in contents]
    assert [file.size for file in received.files] == [len(content) for content in contents]


def test_text_fields_are_read_as_utf8(tmp_path: Path) -> None:
    received = receive(tmp_path, form([("name", None, "Krug, größer".encode())]), piece=3)
    assert received.fields == {"name": "Krug, größer"}


def test_a_body_cut_anywhere_before_its_end_is_refused(tmp_path: Path) -> None:
    body = form([("files", "a.ply", b"ply"), ("files", "b.png", b"png")])
    for length in range(len(body) - len(b"--\r\n")):
        with pytest.raises((IncompleteBody, BadMultipart)):
            receive(tmp_path, body[:length])


@pytest.mark.parametrize(
    "kind", ["", "application/json", "multipart/form-data", "multipart/mixed; boundary=b"]
)
def test_another_media_type_is_refused(tmp_path: Path, kind: str) -> None:
    with pytest.raises(NotMultipart):
        FormReceiver(kind, tmp_path, LIMITS)


@pytest.mark.parametrize(
    "parts",
    [
        [("files", "a.ply", b"1"), ("files", "./a.ply", b"2")],
        [("mesh", "a.ply", b"1")],
        [("name", None, b"1"), ("name", None, b"2")],
        [("name", None, b"\xff")],
    ],
    ids=["two files of one name", "file in another field", "field twice", "not UTF-8"],
)
def test_a_form_that_could_be_misunderstood_is_refused(tmp_path: Path, parts: list[Part]) -> None:
    with pytest.raises(BadMultipart):
        receive(tmp_path, form(parts))


@pytest.mark.parametrize("name", ["../a.ply", "/a.ply", "a/../../b.ply", "", "a\x07.ply", "x" * 2000])
def test_a_file_name_that_is_no_plain_relative_path_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(MeshError, match="unsafe_reference"):
        receive(tmp_path, form([("files", name, b"")]))


def test_bounds_on_counts_and_lengths_hold(tmp_path: Path) -> None:
    with pytest.raises(TooManyFiles):
        receive(tmp_path, form([("files", f"{i}.png", b"") for i in range(4)]))
    with pytest.raises(TooManyFiles):
        receive(tmp_path, form([(f"field{i}", None, b"") for i in range(17)]))
    with pytest.raises(FieldTooLong):
        receive(tmp_path, form([("name", None, b"x" * 101)]), piece=7)


def test_a_part_without_a_name_is_refused(tmp_path: Path) -> None:
    with pytest.raises(BadMultipart):
        receive(tmp_path, b"--b0\r\nContent-Type: text/plain\r\n\r\nx\r\n--b0--\r\n")


def test_garbage_is_refused(tmp_path: Path) -> None:
    with pytest.raises(BadMultipart):
        receive(tmp_path, b"no boundary at all, only text\r\n" * 3)
