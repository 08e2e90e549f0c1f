import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from index.reordering import reorder


@given(n_rows=st.integers(0, 60), data=st.data())
def test_rows_come_in_any_order_of_some_of_them(n_rows: int, data: st.DataObject) -> None:
    order = np.array(
        data.draw(st.permutations(range(n_rows)))[: data.draw(st.integers(0, n_rows))], dtype=np.int64
    )
    rows = np.random.default_rng(n_rows).normal(size=(n_rows, 3)).astype(np.float32)
    expected = rows[order]
    kept = rows[len(order) :].copy()
    reorder(rows, order)
    np.testing.assert_array_equal(rows[: len(order)], expected)
    np.testing.assert_array_equal(rows[len(order) :], kept)  # what lies beyond is not touched


def test_bytes_are_reordered_too_and_the_order_itself_is_not_changed() -> None:
    rows = np.arange(200, dtype=np.uint8)[:, None] * np.ones(2, np.uint8)
    order = np.random.default_rng(0).permutation(200)
    told = order.copy()
    reorder(rows, order)
    np.testing.assert_array_equal(rows[:, 0], order)
    np.testing.assert_array_equal(order, told)
