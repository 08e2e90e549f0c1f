"""Indices and numbers from outside are checked before anything uses them."""

import numpy as np
import pytest

from worker.errors import Code, MeshError
from worker.reading.contents import among, check_finite, check_indices


@pytest.mark.parametrize("index", [-1, 3, 10**12])
def test_an_index_that_names_nothing_is_refused(index: int) -> None:
    with pytest.raises(MeshError) as caught:
        check_indices(np.array([0, 2, index]), 3)
    assert caught.value.code == Code.INDEX_OUT_OF_RANGE
    assert str(index) in caught.value.detail


def test_indices_within_the_file_pass() -> None:
    check_indices(np.array([0, 1, 2]), 3)
    check_indices(np.zeros(0, dtype=np.int64), 0)


@pytest.mark.parametrize("number", [np.nan, np.inf, -np.inf, 1e101])
def test_a_number_that_cannot_be_computed_with_is_refused_with_its_row(number: float) -> None:
    rows = np.zeros((4, 3))
    rows[2, 1] = number
    with pytest.raises(MeshError, match="number 3") as caught:
        check_finite(rows, "coordinates")
    assert caught.value.code == Code.NON_FINITE


def test_thousands_of_names_make_one_short_warning() -> None:
    (warning,) = among(["a" * 100] * 5_000, "were not sent")
    assert warning.startswith("5000 were not sent")
    assert len(warning) < 300
    assert among([], "were not sent") == []
