"""Keys are ours, and signatures come back as they were."""

from pathlib import Path

import numpy as np
import pytest

from index.errors import FileMissing
from index.file_places import open_files
from index.files import FileStore
from service.storage import (
    THUMBNAIL,
    derived_key,
    load_signature,
    load_signatures,
    save_signatures,
    upload_key,
)
from tests.storages import PLACES

pytestmark = pytest.mark.usefixtures("storage")  # with files in a folder and in a bucket


@pytest.fixture
def files(tmp_path: Path) -> FileStore:
    return open_files(PLACES.url(tmp_path), tmp_path / "files")


def test_keys_tell_whose_file_it_is() -> None:
    assert upload_key("u1", 3) == "uploads/u1/3"
    assert derived_key("s1", THUMBNAIL) == "shapes/s1/thumbnail.png"


def test_signatures_come_back_bit_for_bit_in_single_precision(files: FileStore) -> None:
    sent = {"areas": np.linspace(0, 1, 7), "hks-0.05": np.random.default_rng(1).normal(size=(7, 6))}
    single = {name: array.astype(np.float32) for name, array in sent.items()}
    save_signatures(files, "s1", single)
    found = load_signatures(files, "s1")
    assert list(found) == list(single)
    for name, array in single.items():
        assert found[name].dtype == np.float32
        np.testing.assert_array_equal(found[name], array)


def test_one_signature_is_read_alone(files: FileStore) -> None:
    sent = {name: np.full((3, 2), number, np.float32) for number, name in enumerate("abc")}
    save_signatures(files, "s1", sent)
    for name, array in sent.items():
        np.testing.assert_array_equal(load_signature(files, "s1", name), array)
    with pytest.raises(KeyError, match="other"):
        load_signature(files, "s1", "other")
    with pytest.raises(FileMissing):
        load_signature(files, "s2", "a")


def test_a_shape_without_signatures_is_named(files: FileStore) -> None:
    with pytest.raises(FileMissing):
        load_signatures(files, "s1")
