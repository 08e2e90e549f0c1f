import numpy as np
import pytest

from benchmarks.made_rows import make_rows
from index.methods import METHODS, with_weights
from index.pgvector.form import Form
from index.pgvector.scans import scan_for
from tests.pgvector_rows import described


@pytest.mark.parametrize("name", ["fused", "chks"])
def test_what_is_beyond_the_reach_of_a_distance_is_farther_and_what_is_within_may_be_as_near(
    name: str,
) -> None:
    made = make_rows(described(), METHODS[name], 5, 1)
    form = Form(made.layout)
    scan = scan_for(form, METHODS[name], made.queries[0], np.full(3, 0.5))
    for distance in (0.0, 1e-6, 0.7, 1e6):
        reach = scan.reach(distance)
        assert scan.least(reach) <= distance * (1.0 + 1e-8)
        assert scan.least(np.nextafter(reach, np.inf)) > distance


def test_a_block_of_no_weight_is_not_computed() -> None:
    made = make_rows(described(), METHODS["chks"], 5, 1)
    own = with_weights(METHODS["chks"], {"hks-0.05": 0.0})
    scan = scan_for(Form(made.layout), own, made.queries[0], np.zeros(3))
    assert list(scan.values) == ["block0", "block2"]
