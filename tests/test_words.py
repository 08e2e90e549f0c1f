"""Words are found where Python's own split finds them."""

from hypothesis import given
from hypothesis import strategies as st

from worker.reading.words import blocks, split_words, with_line_feeds

TEXT = st.text(alphabet="ab \t\n\r\v\f#", max_size=60).map(str.encode)


@given(TEXT)
def test_words_are_those_of_split(text: bytes) -> None:
    words = split_words(text)
    found = [words.word(place).encode() for place in range(words.starts.size)]
    assert found == text.split()


@given(TEXT)
def test_each_word_knows_its_line(text: bytes) -> None:
    words = split_words(text, first_line=5)
    expected = [5 + line for line, content in enumerate(text.split(b"\n")) for _ in content.split()]
    assert words.lines.tolist() == expected


@given(TEXT, st.integers(1, 10))
def test_blocks_are_the_text_cut_at_line_ends(text: bytes, size: int) -> None:
    pieces = list(blocks(text, size))
    assert b"".join(piece for piece, _ in pieces) == text
    assert all(piece.endswith(b"\n") for piece, _ in pieces[:-1])
    assert [line for _, line in pieces] == [
        1 + b"".join(piece for piece, _ in pieces[:place]).count(b"\n") for place in range(len(pieces))
    ]


def test_line_ends_of_every_system_become_line_feeds() -> None:
    assert with_line_feeds(b"a\r\nb\rc\nd") == b"a\nb\nc\nd"
