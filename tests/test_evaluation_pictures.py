"""Pictures are drawn when they are asked for, of the mesh that was described."""

import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from service.evaluation.folder import read_folder
from service.evaluation.pictures import SIDE, Pictures
from service.evaluation.suites import Suite, suites
from tests.evaluations import make_folder, setting_for
from worker.arrays import ByteArray


@pytest.fixture
def tests(tmp_path: Path) -> list[Suite]:
    return suites(read_folder(make_folder(tmp_path)), twins=True, hard=False)


@pytest.fixture
def pictures(tmp_path: Path, tests: list[Suite]) -> Pictures:
    return Pictures(setting_for(tmp_path, tmp_path / "cache"), tests)


def pixels(png: bytes) -> ByteArray:
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGBA"))


def mean_red(png: bytes) -> float:
    """Return the mean share of red where something is drawn."""
    image = pixels(png).astype(float)
    inside = image[..., 3] > 128
    return float(image[inside][:, 0].mean() / image[inside][:, :3].mean())


def test_queries_and_shapes_have_pictures_by_their_names(pictures: Pictures, tests: list[Suite]) -> None:
    names = {entry.name for test in tests for entry in test.gallery}
    names |= {query.name for test in tests for query in test.queries}
    assert set(pictures) == names
    assert len(pictures) == len(names)


def test_a_picture_is_a_small_png_with_something_on_it(pictures: Pictures) -> None:
    image = pixels(pictures["fish"])
    assert image.shape == (SIDE, SIDE, 4)
    assert 0.02 < (image[..., 3] > 128).mean() < 0.9


def test_a_picture_shows_what_was_changed(pictures: Pictures) -> None:
    assert mean_red(pictures["fish, hue 5"]) > mean_red(pictures["fish"]) + 0.1
    different = {pictures[name] for name in ("fish", "fish (twin 0)", "fish, partiality 5", "bird")}
    assert len(different) == 4


def test_nothing_is_drawn_before_it_is_asked_for_nor_twice(pictures: Pictures, tmp_path: Path) -> None:
    (tmp_path / "posed/bird/pose_00.ply").unlink()
    first = pictures["fish"]
    (tmp_path / "posed/fish/pose_00.ply").unlink()
    assert pictures["fish"] == first


def test_a_mesh_that_is_refused_has_no_picture(pictures: Pictures, tmp_path: Path) -> None:
    (tmp_path / "posed/fish/pose_01.ply").write_bytes(b"")
    assert pictures.get("fish, isometry+topology 3") is None
    assert pictures.get("nobody") is None
    assert pictures.get("fish") is not None
