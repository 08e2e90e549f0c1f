import struct

import numpy as np

from index.pgvector.copying import END, HEAD, copied, literal


def test_a_row_is_three_fields_with_their_lengths_before_them() -> None:
    kept, rows = np.array([[1.0, -2.0]], dtype=np.float16), np.array([[7, 9]], dtype=np.uint8)
    head, row, end = copied(["ü"], kept, rows)
    assert (head, end) == (HEAD, END)
    vector = struct.pack(">hh", 2, 0) + struct.pack(">ee", 1.0, -2.0)
    assert row == b"\0\3" + b"\0\0\0\2" + "ü".encode() + b"\0\0\0\x08" + vector + b"\0\0\0\2" + b"\7\x09"


def test_a_vector_is_written_without_loss() -> None:
    numbers = np.array([0.1, 1e-30, -3.0], dtype=np.float32)
    read = np.array(literal(numbers)[1:-1].split(","), dtype=np.float64)
    assert (read.astype(np.float32) == numbers).all()
