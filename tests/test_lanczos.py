import numpy as np
import pytest

from worker.arrays import FloatArray
from worker.geometry.lanczos import dominant_pairs


def symmetric(values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return a symmetric matrix with given eigenvalues, and its eigenvectors as columns."""
    random = np.random.default_rng(3)
    vectors = np.linalg.qr(random.standard_normal((len(values), len(values))))[0]
    return vectors * values @ vectors.T, vectors


def projector(rows: FloatArray) -> FloatArray:
    return rows.T @ rows


def test_the_span_is_that_of_the_values_greatest_in_modulus() -> None:
    values = np.r_[-9.0, -5.0, 4.0, 6.0, 8.0, np.linspace(-1.0, 1.0, 195)]
    matrix, vectors = symmetric(values)
    found = dominant_pairs(lambda rows: rows @ matrix, 200, 5, 3.5)
    assert found is not None
    np.testing.assert_allclose(found[0], [-9.0, 8.0, 6.0, -5.0, 4.0], rtol=1e-12)
    np.testing.assert_allclose(found[1] @ found[1].T, np.eye(5), atol=1e-10)
    np.testing.assert_allclose(projector(found[1]), projector(vectors[:, :5].T), atol=1e-7)


@pytest.mark.parametrize("multiplicity", [2, 5, 9])
def test_values_of_any_multiplicity_are_waited_for(multiplicity: int) -> None:
    values = np.r_[np.full(multiplicity, 5.0), np.linspace(0.0, 1.0, 300)]
    matrix, vectors = symmetric(values)
    found = dominant_pairs(lambda rows: rows @ matrix, len(values), multiplicity, 4.9)
    assert found is not None
    np.testing.assert_allclose(projector(found[1]), projector(vectors[:, :multiplicity].T), atol=1e-7)


def test_more_values_than_there_are_give_nothing() -> None:
    matrix, _ = symmetric(np.r_[7.0, 5.0, np.linspace(0.0, 1.0, 100)])
    assert dominant_pairs(lambda rows: rows @ matrix, 102, 3, 4.9) is None


def test_the_same_operator_gives_the_same_bits() -> None:
    matrix, _ = symmetric(1.0 / np.arange(1, 121))
    first, second = (dominant_pairs(lambda rows: rows @ matrix, 120, 4, 0.25) for _ in range(2))
    assert first is not None
    assert second is not None
    assert first[1].tobytes() == second[1].tobytes()
