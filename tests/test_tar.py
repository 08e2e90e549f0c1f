"""Headers of plain files: the standard library reads ours, and ours refuses what is damaged."""

import io
import tarfile

import pytest
from hypothesis import given
from hypothesis import strategies as st

from index.errors import DamagedExport
from service.backup.tar import BLOCK, END, Member, header_of, member_of, padding_of

NAMES = st.from_regex(r"files/[a-z0-9]{1,40}/[a-z0-9.]{1,100}", fullmatch=True)


@given(name=NAMES, size=st.integers(0, 2**50))
def test_a_header_comes_back_whatever_the_size(name: str, size: int) -> None:
    member = Member(name=name, size=size)
    header = header_of(member, 1_700_000_000)
    assert len(header) == BLOCK
    assert member_of(header) == member
    assert tarfile.TarInfo.frombuf(header, "utf-8", "strict").mtime == 1_700_000_000


@given(size=st.integers(0, 3 * BLOCK))
def test_the_standard_library_reads_what_is_put_together(size: int) -> None:
    content = b"x" * size
    whole = header_of(Member(name="a", size=size), 0) + content + padding_of(size) + END
    with tarfile.open(fileobj=io.BytesIO(whole)) as archive:
        (info,) = archive.getmembers()
        stream = archive.extractfile(info)
        assert stream is not None
        assert stream.read() == content


@given(place=st.integers(0, BLOCK - 1), change=st.integers(1, 255))
def test_a_changed_byte_of_a_header_is_noticed_or_means_nothing(place: int, change: int) -> None:
    header = bytearray(header_of(Member(name="files/a", size=1234), 5))
    header[place] ^= change
    try:
        found = member_of(bytes(header))
    except DamagedExport:
        return
    assert found == Member(name="files/a", size=1234)


def test_zeros_are_the_end_and_less_than_a_block_is_damage() -> None:
    assert member_of(bytes(BLOCK)) is None
    for block in (b"", bytes(BLOCK - 1), b"\xff" * BLOCK):
        with pytest.raises(DamagedExport, match="damaged"):
            member_of(block)


def test_a_negative_size_is_refused() -> None:
    info = tarfile.TarInfo("a")
    info.size = -1
    with pytest.raises(DamagedExport, match="plain file"):
        member_of(info.tobuf(tarfile.GNU_FORMAT))
