from typing import Any

from index import bounds, distances, merging, ordering, reordering
from index.rehearsal import rehearse


def test_after_a_rehearsal_all_that_a_search_calls_is_compiled() -> None:
    rehearse()
    called: list[Any] = [bounds.box_bounds, bounds.least_bounds, bounds.rows_within, bounds.fine_bounds]
    called += [distances._byte_distances, distances._single_distances, merging._assign, merging._sums]
    called += [ordering._halve, reordering._reorder]
    assert all(function.signatures for function in called)
