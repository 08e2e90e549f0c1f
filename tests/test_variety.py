"""Random shapes are many, readable, and the same for the same seed."""

from service.samples.objects import THINGS
from service.samples.variety import GROWN, random_creatures
from worker.geometry.repair import repair
from worker.reading.upload import Upload, read_mesh


def test_the_same_seed_gives_the_same_files() -> None:
    first, second = (list(random_creatures(3, seed=5)) for _ in range(2))
    assert [sample.files for sample in first] == [sample.files for sample in second]
    other = next(random_creatures(1, seed=6))
    assert other.files != first[0].files


def test_every_random_shape_is_accepted() -> None:
    kinds = set()
    for sample in random_creatures(24, seed=1):
        repaired = repair(read_mesh(Upload(files=sample.files)))
        assert len(repaired.faces) >= 12
        kinds.add(sample.metadata["kind"])
    assert len(kinds) > 9
    assert kinds & (set(THINGS) | set(GROWN))
    assert "box" in kinds
