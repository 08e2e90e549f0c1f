"""Damage to any bytes: bits, numbers, pieces."""

from random import Random

BOUNDARIES = (0, 1, 2, 3, 4, 2**7, 2**8 - 1, 2**15, 2**16 - 1, 2**31 - 1, 2**31, 2**32 - 1, 2**63, 2**64 - 1)
LONGEST = 2_000  # bytes of a piece that is moved about


def piece(size: int, rng: Random) -> tuple[int, int]:
    """Return where a random piece of so many bytes starts and ends; short ones are likelier."""
    start = rng.randrange(size + 1)
    return start, min(size, start + rng.choice((1, 2, 4, 8, 30, 200, LONGEST)))


def flip_bit(data: bytes, rng: Random) -> bytes:
    """Turn one bit over."""
    if not data:
        return data
    place = rng.randrange(len(data))
    return data[:place] + bytes([data[place] ^ (1 << rng.randrange(8))]) + data[place + 1 :]


def set_byte(data: bytes, rng: Random) -> bytes:
    """Write any byte over another."""
    place = rng.randrange(len(data) + 1)
    return data[:place] + bytes([rng.randrange(256)]) + data[place + 1 :]


def write_number(data: bytes, rng: Random) -> bytes:
    """Write a number at the edge of a type over what is there, in either byte order."""
    width = rng.choice((1, 2, 4, 8))
    number = rng.choice(BOUNDARIES) % (1 << 8 * width)
    place = rng.randrange(len(data) + 1)
    return data[:place] + number.to_bytes(width, rng.choice(("little", "big"))) + data[place + width :]


def remove_piece(data: bytes, rng: Random) -> bytes:
    """Take a piece out."""
    start, end = piece(len(data), rng)
    return data[:start] + data[end:]


def repeat_piece(data: bytes, rng: Random) -> bytes:
    """Write a piece several times."""
    start, end = piece(len(data), rng)
    return data[:end] + data[start:end] * rng.choice((1, 2, 10)) + data[end:]


def insert_noise(data: bytes, rng: Random) -> bytes:
    """Put random bytes, zeros or blanks in between."""
    place, size = rng.randrange(len(data) + 1), rng.choice((1, 2, 4, 100))
    noise = rng.choice((rng.randbytes(size), bytes(size), b" " * size, b"\n" * size, b"\xff" * size))
    return data[:place] + noise + data[place:]


def swap_pieces(data: bytes, rng: Random) -> bytes:
    """Let two pieces change places."""
    first, second = sorted((piece(len(data), rng), piece(len(data), rng)))
    end = min(first[1], second[0])
    return (
        data[: first[0]]
        + data[slice(*second)]
        + data[end : second[0]]
        + data[first[0] : end]
        + data[second[1] :]
    )


def blank_piece(data: bytes, rng: Random) -> bytes:
    """Write zeros over a piece."""
    start, end = piece(len(data), rng)
    return data[:start] + bytes(end - start) + data[end:]


def truncate(data: bytes, rng: Random) -> bytes:
    """End early, more often near the end."""
    kept = rng.choice((rng.randrange(len(data) + 1), len(data) - rng.randrange(1, 20)))
    return data[: max(kept, 0)]


def splice(data: bytes, donor: bytes, rng: Random) -> bytes:
    """Go on as another file does, or hold a piece of it."""
    place = rng.randrange(len(data) + 1)
    if rng.random() < 0.5:
        return data[:place] + donor[rng.randrange(len(donor) + 1) :]
    start, end = piece(len(donor), rng)
    return data[:place] + donor[start:end] + data[place + rng.choice((0, end - start)) :]
