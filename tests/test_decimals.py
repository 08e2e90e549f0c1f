import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from worker.reading.decimals import read_decimal


def number(word: str) -> float | None:
    value, end = read_decimal(np.frombuffer(word.encode(), dtype=np.uint8), 0)
    return value if end == len(word) else None


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_numbers_are_right_to_the_last_bit_or_left_to_others(value: float) -> None:
    assert number(repr(value)) in {value, None}


@given(st.integers(1, 10**18), st.integers(0, 22))
def test_long_fractions_are_rounded_once(digits: int, places: int) -> None:
    word = f"{digits}e-{places}"
    assert number(word) in {float(word), None}
    assert digits > 2**53 or number(word) is not None
