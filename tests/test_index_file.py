from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from index import index_file, sketch, vectors
from index.errors import DamagedIndex
from index.index_file import Header, load_index, save_index
from index.layout import Layout
from index.local_files import LocalFiles
from index.methods import METHODS
from index.ranking import rank
from index.vectors import Vectors
from tests.layouts import random_rows

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


@pytest.fixture(autouse=True)
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(index_file, "_PIECE", 16)  # arrays of several pieces, the last one smaller
    monkeypatch.setattr(vectors, "SKETCHED", 10)
    monkeypatch.setattr(sketch, "BOX", 4)


@pytest.fixture
def filled() -> Vectors:
    made = Vectors(LAYOUT)
    made.put(HEADER.ids, random_rows(LAYOUT, 25))
    made.settle()
    return made


def saved(folder: Path, filled: Vectors) -> Path:
    header = replace(HEADER, ids=list(filled.ids))
    save_index(LocalFiles(folder), "m.vectors", header, filled.arrays())
    return folder / "m.vectors"


def test_an_index_comes_back_bit_for_bit(tmp_path: Path, filled: Vectors) -> None:
    header, arrays = load_index(saved(tmp_path, filled))
    assert header == replace(HEADER, ids=list(filled.ids))
    expected = filled.arrays()
    assert arrays.keys() == expected.keys()
    for name, array in expected.items():
        assert (arrays[name].dtype, arrays[name].shape) == (array.dtype, array.shape)
        assert arrays[name].tobytes() == array.tobytes()


def test_what_was_loaded_ranks_as_before_and_may_grow(tmp_path: Path, filled: Vectors) -> None:
    header, arrays = load_index(saved(tmp_path, filled))
    again = Vectors.restored(LAYOUT, header.ids, arrays)
    query, more = random_rows(LAYOUT, 1, 1)[0], random_rows(LAYOUT, 30, 2)
    assert rank(again, query, 9) == rank(filled, query, 9)
    for each in (again, filled):
        each.put([f"t{number}" for number in range(30)], more)
    assert rank(again, query, 9) == rank(filled, query, 9)


def test_empty_arrays_and_arrays_without_axes_come_back(tmp_path: Path) -> None:
    arrays = {"none": np.empty((0, 3), np.float32), "one": np.array(7), "two": np.array([True, False])}
    save_index(LocalFiles(tmp_path), "m", HEADER, arrays)
    _, read = load_index(tmp_path / "m")
    for name, array in arrays.items():
        assert read[name].shape == array.shape
        np.testing.assert_array_equal(read[name], array)


def test_every_flipped_bit_and_every_cut_is_noticed(tmp_path: Path, filled: Vectors) -> None:
    path = saved(tmp_path, filled)
    whole = path.read_bytes()
    for position in range(0, len(whole), 7):
        flipped = bytes([whole[position] ^ 0x10])
        for damaged in (whole[:position], whole[:position] + flipped + whole[position + 1 :]):
            path.write_bytes(damaged)
            with pytest.raises(DamagedIndex):
                load_index(path)


def test_an_absent_file_and_another_format_are_refused(tmp_path: Path) -> None:
    with pytest.raises(DamagedIndex, match="cannot be read"):
        load_index(tmp_path / "none")
    save_index(LocalFiles(tmp_path), "m", replace(HEADER, format=99), {})
    with pytest.raises(DamagedIndex, match="format 99"):
        load_index(tmp_path / "m")
