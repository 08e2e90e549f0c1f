"""A description tells its stages, and is the same whether or not anyone listens."""

import numpy as np

from service.jobs.rehearsal import SMALL
from service.jobs.timing import timed
from tests.small_library import good_mesh
from worker.describe import describe
from worker.reading.upload import Upload
from worker.stages import STAGES


def test_every_stage_is_told_in_turn_and_changes_nothing() -> None:
    upload = Upload(files=good_mesh(1))
    quiet, heard = describe(upload, SMALL), timed(describe, upload, SMALL)
    assert {each.name for each in heard.stages} == set(STAGES)
    assert [each.name for each in heard.stages][:2] == ["read", "repair"]
    assert heard.stages[-1].name == "pictures"
    for one, other in ((quiet.blocks, heard.value.blocks), (quiet.signatures, heard.value.signatures)):
        assert one.keys() == other.keys()
        assert all(np.array_equal(one[name], other[name]) for name in one)
    assert (quiet.thumbnail, quiet.preview) == (heard.value.thumbnail, heard.value.preview)
