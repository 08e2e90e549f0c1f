import numpy as np
import numpy.typing as npt
from hypothesis import given
from hypothesis import strategies as st

from index.layout import Layout
from index.methods import Block, Method
from index.vectors import Vectors

LAYOUT = Layout(
    method=Method(
        name="m",
        blocks=(Block(name="a", weight=1 / 0.587, power=1), Block(name="b", weight=1 / 150.5, power=1)),
        description="",
    ),
    lengths=(2, 3),
)


def random_rows(n_rows: int, seed: int = 0) -> npt.NDArray[np.float32]:
    return np.random.default_rng(seed).normal(0, 100, (n_rows, LAYOUT.width)).astype(np.float32)


steps = st.lists(
    st.tuples(st.sampled_from(["put", "remove"]), st.sets(st.integers(0, 30), max_size=12)), max_size=12
)


@given(steps=steps)
def test_after_any_changes_the_vectors_are_those_of_a_dictionary(
    steps: list[tuple[str, set[int]]],
) -> None:
    vectors = Vectors(LAYOUT)
    expected: dict[str, npt.NDArray[np.float32]] = {}
    for seed, (action, numbers) in enumerate(steps):
        ids = [f"s{number}" for number in sorted(numbers)]
        if action == "put":
            rows = random_rows(len(ids), seed)
            vectors.put(ids, rows)
            expected.update(zip(ids, rows, strict=True))
        else:
            vectors.remove(ids)
            for shape_id in ids:
                expected.pop(shape_id, None)
    assert len(vectors) == len(expected)
    assert set(vectors.ids) == expected.keys()
    for shape_id, row in expected.items():
        position = vectors.positions([shape_id])
        assert vectors.ids[int(position[0])] == shape_id
        assert vectors.rows(position)[0].tobytes() == row.tobytes()  # bit for bit, in spite of scaling
        nearest, sums = vectors.nearest(row, 1)
        assert vectors.rows(nearest)[0].tobytes() == row.tobytes()
        assert sums[0] == 0.0


def test_the_nearest_come_in_the_order_of_the_scaled_distance() -> None:
    rows = random_rows(50)
    vectors = Vectors(LAYOUT)
    vectors.put([str(i) for i in range(50)], rows)
    expected = np.abs((rows - rows[7]) * LAYOUT.scales).sum(axis=1)
    positions, sums = vectors.nearest(rows[7], 20)
    np.testing.assert_array_equal(positions, np.argsort(expected)[:20])
    np.testing.assert_allclose(sums, np.sort(expected)[:20], rtol=1e-5)


def test_a_radius_takes_in_its_own_border() -> None:
    vectors = Vectors(LAYOUT)
    rows = np.zeros((4, LAYOUT.width), dtype=np.float32)
    rows[:, 2] = [0, 1, 2, 3]  # in the widest block, which is not scaled
    vectors.put(list("abcd"), rows)
    within = vectors.within(np.zeros(LAYOUT.width, dtype=np.float32), 2.0)
    assert sorted(within.tolist()) == [0, 1, 2]


def test_the_largest_norm_bounds_every_vector() -> None:
    vectors = Vectors(LAYOUT)
    for seed in range(3):
        rows = random_rows(5, seed)
        vectors.put([f"{seed}-{i}" for i in range(5)], rows)
        assert vectors.largest_norm >= np.abs(vectors.scaled(rows)).sum(axis=1).max() * (1 - 1e-6)


def test_unknown_ids_are_nowhere_and_their_removal_changes_nothing() -> None:
    vectors = Vectors(LAYOUT)
    vectors.put(["a"], random_rows(1))
    vectors.remove(["b"])
    assert vectors.positions(["b", "a", "a"]).tolist() == [0]
    assert len(vectors) == 1
