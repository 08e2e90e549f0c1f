"""Numbers are read as Python reads them, and everything else is refused by name."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.mesh_files import attempt
from worker.errors import Code, MeshError
from worker.reading.parsing import parse_floats, parse_integers
from worker.reading.words import Words, split_words

ODD = [
    "nan",
    "inf",
    "-inf",
    "1.#IND",
    "-1.#INF",
    "x",
    "1,5",
    "1_0",
    "0x1",
    "1e",
    "--1",
    "1-2",
    "1.2.3",
    "٣",
    "e",
]


@given(st.lists(st.floats(allow_nan=False).map(repr), max_size=20))
def test_floats_survive_to_the_last_bit(numbers: list[str]) -> None:
    found = parse_floats(split_words(" ".join(numbers).encode()))
    assert found.tolist() == [float(number) for number in numbers]


@given(st.lists(st.integers(-(10**17), 10**17), max_size=20))
def test_whole_numbers_are_exact(numbers: list[int]) -> None:
    assert parse_integers(split_words(" ".join(map(str, numbers)).encode())).tolist() == numbers


@given(st.lists(st.one_of(st.sampled_from([*ODD, "1", "-.5", "3."]), st.text(max_size=4)), max_size=4))
def test_any_words_give_numbers_or_a_refusal(texts: list[str]) -> None:
    words = split_words(" ".join(texts).encode())
    assert attempt(lambda: parse_floats(words)) in {None, Code.BAD_NUMBER}
    assert attempt(lambda: parse_integers(words)) in {None, Code.BAD_NUMBER}


@pytest.mark.parametrize("word", ["x", "1,5", "1_0", "0x1", "1e", "--1", "1-2", "1.2.3", "٣"])
def test_a_word_that_is_no_number_is_named_with_its_line(word: str) -> None:
    with pytest.raises(MeshError, match=f"Line 2: expected a number, found “{word}”"):
        parse_floats(split_words(f"1 2\n3 {word} 4".encode()))


@pytest.mark.parametrize("word", ["1.#IND", "-1.#INF", "nan", "-nan"])
def test_what_programs_write_for_no_number_is_read_as_such(word: str) -> None:
    assert np.isnan(parse_floats(split_words(word.encode()))).all()


def test_an_empty_word_is_zero_among_whole_numbers() -> None:
    words = split_words(b"12 34")
    empty = Words(text=words.text, starts=words.starts, ends=words.ends - np.array([2, 0]), lines=words.lines)
    assert parse_integers(empty).tolist() == [0, 34]


@pytest.mark.parametrize("word", ["1.0", "1" * 19, "+", "9" * 30])
def test_what_is_no_whole_number_or_too_long_is_refused(word: str) -> None:
    with pytest.raises(MeshError, match="expected a whole number"):
        parse_integers(split_words(word.encode()))
