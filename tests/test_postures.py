"""Postures are read once for each state of a shape, and a few thousand are remembered."""

from pathlib import Path

import numpy as np
import pytest

from index.local_files import LocalFiles
from service.relations import postures
from service.relations.postures import Postures, posture_of, rehearse
from service.storage import PREVIEW, derived_key
from tests.shapes import sphere
from worker.descriptors.posture import _cumulated
from worker.pictures.preview import preview


def glb(height: float = 1.0) -> bytes:
    vertices, faces = sphere(2)
    return preview(vertices * [1.0, 1.0, height] * 30.0, faces, np.zeros(vertices.shape))


@pytest.fixture
def files(tmp_path: Path) -> LocalFiles:
    store = LocalFiles(tmp_path)
    store.put(derived_key("a", PREVIEW), glb())
    return store


def test_a_posture_is_remembered_until_the_shape_changes(files: LocalFiles) -> None:
    known = Postures()
    first = known.of(files, "a", 1)
    np.testing.assert_array_equal(first, posture_of(glb()))
    files.put(derived_key("a", PREVIEW), glb(height=2.0))
    assert known.of(files, "a", 1) is first
    np.testing.assert_array_equal(known.of(files, "a", 2), posture_of(glb(height=2.0)))


def test_without_a_preview_there_is_none_until_it_comes(files: LocalFiles) -> None:
    known = Postures()
    assert known.of(files, "b", 1) is None
    files.put(derived_key("b", PREVIEW), glb())
    assert known.of(files, "b", 1) is not None


def test_what_is_no_preview_has_no_posture(files: LocalFiles) -> None:
    files.put(derived_key("a", PREVIEW), b"no GLB")
    assert Postures().of(files, "a", 1) is None
    assert posture_of(b"") is None


def test_the_longest_unused_is_forgotten(files: LocalFiles, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(postures, "MOST", 2)
    known = Postures()
    for revision in (1, 2, 1, 3):
        known.of(files, "a", revision)
    first = known.of(files, "a", 1)
    files.delete(derived_key("a", PREVIEW))
    assert known.of(files, "a", 1) is first
    assert known.of(files, "a", 2) is None  # forgotten, and gone


def test_what_is_rehearsed_is_compiled() -> None:
    rehearse()
    assert _cumulated.signatures  # type: ignore[attr-defined]  # numba's
