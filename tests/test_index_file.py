from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from index import index_file
from index.errors import DamagedIndex
from index.files import FileStore
from index.index_file import Header, opened_index, save_index
from index.layout import Layout
from index.methods import METHODS
from index.vectors import Vectors

LAYOUT = Layout(method=METHODS["fused"], lengths=(3, 5, 2))
HEADER = Header(
    library="l",
    epoch=3,
    vocabulary_id="v-ä",
    blocks=["log-hks", "colour-histogram", "colour-curves"],
    lengths=[3, 5, 2],
    ids=[f"s{number}" for number in range(25)],
    revisions=list(range(25)),
)


@pytest.fixture
def vectors(monkeypatch: pytest.MonkeyPatch) -> Vectors:
    monkeypatch.setattr(index_file, "_CHUNK", 4)  # several pieces, the last one smaller
    vectors = Vectors(LAYOUT)
    rows = np.random.default_rng(0).normal(0, 30, (25, LAYOUT.width)).astype(np.float32)
    vectors.put(HEADER.ids, rows)
    return vectors


def test_an_index_comes_back_bit_for_bit(tmp_path: Path, vectors: Vectors) -> None:
    save_index(FileStore(tmp_path), "fused.vectors", HEADER, vectors)
    with opened_index(tmp_path / "fused.vectors") as (header, pieces):
        assert header == HEADER
        read = list(pieces)
    assert [shape_id for ids, _ in read for shape_id in ids] == HEADER.ids
    rows = np.vstack([rows for _, rows in read])
    assert rows.tobytes() == vectors.rows(np.arange(25)).tobytes()


def test_every_flipped_bit_and_every_cut_is_noticed(tmp_path: Path, vectors: Vectors) -> None:
    path = tmp_path / "m.vectors"
    save_index(FileStore(tmp_path), "m.vectors", HEADER, vectors)
    whole = path.read_bytes()
    for position in range(0, len(whole), 7):
        for damaged in (
            whole[:position],
            whole[:position] + bytes([whole[position] ^ 0x10]) + whole[position + 1 :],
        ):
            path.write_bytes(damaged)
            with pytest.raises(DamagedIndex), opened_index(path):
                pass


def test_an_absent_file_and_another_format_are_refused(tmp_path: Path, vectors: Vectors) -> None:
    with pytest.raises(DamagedIndex, match="cannot be read"), opened_index(tmp_path / "none"):
        pass
    save_index(FileStore(tmp_path), "m", replace(HEADER, format=99), vectors)
    with pytest.raises(DamagedIndex, match="format 99"), opened_index(tmp_path / "m"):
        pass
