"""Text from a file reads well in a message, whatever the file says."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from worker.reading.showing import LONGEST, shown


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a.ply", "“a.ply”"),
        ("übung/形 1.obj", "“übung/形 1.obj”"),
        ("", "“”"),
        ("1\x002\x1b[31m\n", "“1␀2␛[31m␊”"),
        ("\x7f\x85\udcff", "“���”"),
        ("gnp.\u202eylp", "“gnp.�ylp”"),
        (b"\x89PNG\r\n", "“�PNG␍␊”"),
        ("é".encode(), "“é”"),
    ],
)
def test_it_is_quoted_and_what_disturbs_a_screen_is_a_sign(text: str | bytes, expected: str) -> None:
    assert shown(text) == expected


def test_what_is_long_is_cut() -> None:
    assert shown("a" * 101) == f"“{'a' * 100}…”"
    assert shown("a" * 100) == f"“{'a' * 100}”"
    assert shown(b"abcdef" * 1000, 3) == "“abc…”"


@given(st.text(st.characters(exclude_categories=[])) | st.binary())
def test_nothing_else_is_printed_than_signs(text: str | bytes) -> None:
    found = shown(text)
    assert len(found) <= LONGEST + 3
    assert not any(ord(sign) < 32 or 127 <= ord(sign) < 160 for sign in found)
    found.encode()  # no half characters
