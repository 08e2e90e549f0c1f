import numpy as np
import pytest

from benchmarks.made_rows import make_rows
from index.distances import distances
from index.layout import Layout
from index.methods import METHODS, with_weights
from index.pgvector.form import Form
from tests.pgvector_rows import described


@pytest.mark.parametrize("name", [name for name, method in METHODS.items() if method.power == 1])
def test_kept_rows_lie_as_far_apart_as_the_rows_but_for_the_errors(name: str) -> None:
    made = make_rows(described(), METHODS[name], 50, 1)
    form, query = Form(made.layout), made.queries
    kept, asked = form.kept(made.rows), form.kept(query)
    exact = distances(made.rows, np.arange(50), query[0], made.layout, METHODS[name])
    apart = np.abs(kept.astype(float) - asked.astype(float)).sum(axis=1) / form.scale
    errors = (form.errors(made.rows, kept) + form.errors(query, asked)).sum(axis=1) / form.scale
    assert (np.abs(apart - exact) <= errors).all()
    assert errors.max() < 0.02 * exact.max()  # so small that they rule out nearly all rows


def test_any_number_is_kept_as_a_finite_one_and_its_error_tells_by_how_much_it_moved() -> None:
    layout = Layout(method=METHODS["hks"], lengths=(2,))
    rows = np.array([[3e38, 1.0]], dtype=np.float32)
    kept = Form(layout).kept(rows)
    assert np.isfinite(kept).all()
    assert Form(layout).errors(rows, kept)[0, 0] > 2.9e38


def test_bytes_stay_within_numbers_of_16_bits() -> None:
    layout = Layout(method=METHODS["fused"], lengths=(1, 1, 1))
    for byte in (0, 255):
        assert np.isfinite(Form(layout).kept(np.full((1, 3), byte, dtype=np.uint8))).all()


def test_other_weights_or_lengths_are_another_form() -> None:
    layout = Layout(method=METHODS["chks"], lengths=(4, 4, 4))
    heavier = Layout(method=with_weights(METHODS["chks"], {"hks-0": 2.0}), lengths=(4, 4, 4))
    longer = Layout(method=METHODS["chks"], lengths=(5, 4, 4))
    assert len({Form(each).name for each in (layout, heavier, longer)}) == 3
    assert Form(layout).name == Form(Layout(method=METHODS["chks"], lengths=(4, 4, 4))).name
