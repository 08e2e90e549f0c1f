"""Numbers in plain decimal notation, read from bytes and right to the last bit."""

import numpy as np

from worker.arrays import ByteArray
from worker.compiled import compiled

POWERS = 10.0 ** np.arange(23)  # exact in double precision
WHOLE = 2**53  # integers below it are doubles
LONGEST = 2**62 // 10  # ten times it and a digit fit into 63 bits
DIGITS = 18  # of a whole number
MINUS, PLUS, POINT = b"-+."
LETTER_E, CAPITAL_E = b"eE"


@compiled
def read_whole(text: ByteArray, at: int) -> tuple[int, int]:
    """Read a whole number; return it and where it ends, −1 where there is none."""
    negative = text[at] == MINUS
    start = at = at + (negative or text[at] == PLUS)
    value = 0
    while at < len(text) and 48 <= text[at] <= 57 and at - start <= DIGITS:
        value = 10 * value + (text[at] - 48)
        at += 1
    if not 0 < at - start <= DIGITS:
        return 0, -1
    return (-value if negative else value), at


@compiled
def read_decimal(text: ByteArray, at: int) -> tuple[float, int]:
    """Read a decimal number; return it and where its word ends, −1 where it is not plain."""
    negative = text[at] == MINUS
    at += negative or text[at] == PLUS
    digits, exponent, n_digits, point = 0, 0, 0, False
    while at < len(text):
        byte = text[at]
        if 48 <= byte <= 57:
            if digits > LONGEST:
                return 0.0, -1
            digits = 10 * digits + (byte - 48)
            n_digits += 1
            exponent -= point
        elif byte == POINT and not point:
            point = True
        else:
            break
        at += 1
    if n_digits == 0:
        return 0.0, -1
    if at < len(text) and (text[at] == LETTER_E or text[at] == CAPITAL_E):
        if at + 1 >= len(text):
            return 0.0, -1
        more, at = read_whole(text, at + 1)
        exponent += more
    if at < 0 or (at < len(text) and text[at] != 32 and not 9 <= text[at] <= 13):
        return 0.0, -1
    value, exact = _decimal(digits, exponent)
    return (-value if negative else value), (at if exact else -1)


@compiled
def _decimal(digits: int, exponent: int) -> tuple[float, bool]:
    """Return digits · 10^exponent rounded once, as Clinger (1990) does, and whether that is certain."""
    if digits == 0:
        return 0.0, True
    if not -22 <= exponent <= 22:
        return 0.0, False
    if digits <= WHOLE:
        return (digits / POWERS[-exponent] if exponent < 0 else digits * POWERS[exponent]), True
    if exponent >= 0:
        return 0.0, False
    power, high = POWERS[-exponent], float(digits)
    quotient = high / power
    product, error = _product(quotient, power)
    rest = ((high - product) - error) + float(digits - int(high))
    correction = rest / power  # of the quotient, itself known to about 50 bits
    value = quotient + correction
    margin = 1e-13 * abs(correction)
    return value, quotient + (correction - margin) == quotient + (correction + margin)


@compiled
def _product(first: float, second: float) -> tuple[float, float]:
    """Return a product and its rounding error (Dekker 1971)."""
    product = first * second
    high, low = _halves(first)
    upper, lower = _halves(second)
    return product, ((high * upper - product) + high * lower + low * upper) + low * lower


@compiled
def _halves(number: float) -> tuple[float, float]:
    shifted = 134_217_729.0 * number  # 2^27 + 1
    high = shifted - (shifted - number)
    return high, number - high
