"""The sample library is what it promises to be."""

import re
from itertools import islice

from service.samples.gallery import CHARACTERS, count_samples, make_samples
from service.samples.sample import Sample


def _vertex_count(sample: Sample) -> int:
    name, content = next((name, data) for name, data in sample.files.items() if name[-4:] in (".ply", ".obj"))
    if name.endswith(".obj"):
        return content.count(b"\nv ")
    found = re.search(rb"element vertex (\d+)", content)
    return int(found[1]) if found else 0


def test_the_library_holds_creatures_poses_and_twins() -> None:
    samples = list(islice(make_samples(), 8))
    assert count_samples() == 4 * len(CHARACTERS)
    assert len({sample.name for sample in samples}) == len(samples)
    assert any(name.endswith(".png") for sample in samples for name in sample.files)
    assert all(3500 < _vertex_count(sample) < 8500 for sample in samples)
    by_kind = [character.kind for character in CHARACTERS]
    assert sum(by_kind.count(kind) > 1 for kind in set(by_kind)) == 2
    of_one = [_vertex_count(sample) for sample in samples if sample.metadata["creature"] == "giraffe"]
    assert len(set(of_one)) == 4
