"""Indexes that were saved, and what can happen to their files."""

from pathlib import Path

from tests.brute_force import add, agrees
from tests.catalogues import Opened, make_searcher


def saved_index(opened: Opened, folder: Path, n_shapes: int = 40) -> Path:
    for number in range(n_shapes):
        add(opened, number)
    searcher = make_searcher(opened, folder)
    assert agrees(searcher, opened)
    searcher.close()
    return folder / "fused.vectors"


def flipped(data: bytes) -> bytes:
    middle = len(data) // 2
    return data[:middle] + bytes([data[middle] ^ 1]) + data[middle + 1 :]
