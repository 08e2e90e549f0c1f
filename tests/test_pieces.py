import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from worker.geometry.pieces import count_components

FACES = st.lists(st.tuples(*[st.integers(0, 20)] * 3), min_size=1, max_size=12)


@given(FACES)
def test_pieces_are_those_of_the_graph_of_edges(listed: list[tuple[int, int, int]]) -> None:
    used, numbered = np.unique(np.array(listed), return_inverse=True)
    faces = numbered.reshape(-1, 3)
    ends = np.concatenate([faces[:, :2], faces[:, 1:]])
    graph = coo_array((np.ones(len(ends)), ends.T), shape=(len(used), len(used)))
    assert count_components(faces, len(used)) == connected_components(graph, directed=False)[0]
