"""Members are read one after the other, whatever of them is taken."""

import io
from hashlib import sha256

import pytest
from hypothesis import given
from hypothesis import strategies as st

from index.errors import DamagedExport
from service.backup.reading import members_of
from service.backup.tar import END, Member, header_of, padding_of

CONTENTS = st.lists(st.binary(max_size=1500), min_size=1, max_size=5)


def packed(contents: list[bytes]) -> bytes:
    parts = [
        header_of(Member(name=str(number), size=len(content)), 0) + content + padding_of(len(content))
        for number, content in enumerate(contents)
    ]
    return b"".join(parts) + END


@given(contents=CONTENTS, taken=st.integers(0, 1500))
def test_the_digest_is_of_everything_however_much_was_taken(contents: list[bytes], taken: int) -> None:
    places: list[int] = []
    whole = packed(contents)
    for stream, content in zip(members_of(io.BytesIO(whole), places.append), contents, strict=True):
        assert content.startswith(stream.read(taken))
        stream.pass_over()
        assert stream.digest() == sha256(content).hexdigest()
        assert stream.size == len(content)
    assert places[-1] == len(whole) - len(END)


@given(lines=st.lists(st.binary(max_size=30).filter(lambda line: b"\n" not in line), max_size=20))
def test_lines_come_whole(lines: list[bytes]) -> None:
    content = b"".join(line + b"\n" for line in lines)
    (stream,) = members_of(io.BytesIO(packed([content])), lambda _: None)
    assert list(stream.lines(40)) == []  # it was passed over
    for again in members_of(io.BytesIO(packed([content])), lambda _: None):
        assert list(again.lines(40)) == [line + b"\n" for line in lines]


def test_a_line_that_is_too_long_is_refused() -> None:
    for stream in members_of(io.BytesIO(packed([b"x" * 50 + b"\n"])), lambda _: None):
        with pytest.raises(DamagedExport, match="more than 40 bytes"):
            list(stream.lines(40))


@given(contents=CONTENTS, cut=st.integers(1, 600))
def test_a_cut_is_noticed(contents: list[bytes], cut: int) -> None:
    whole = packed(contents)[: -len(END)]
    with pytest.raises(DamagedExport, match=r"cut|damaged"):
        list(members_of(io.BytesIO(whole[:-cut]), lambda _: None))


def test_padding_and_end_are_zeros() -> None:
    whole = bytearray(packed([b"x"]))
    whole[600] = 1
    with pytest.raises(DamagedExport, match="after '0'"):
        list(members_of(io.BytesIO(whole), lambda _: None))
    with pytest.raises(DamagedExport, match="follows the end"):
        list(members_of(io.BytesIO(packed([b"x"]) + b"\0\1"), lambda _: None))
