"""Another process locks the catalogue: writers are told, readers do not notice."""

from collections import Counter
from pathlib import Path

from soak.locked import WRITERS, run


def test_a_locked_catalogue_keeps_answering_and_tells_writers_to_come_back(tmp_path: Path) -> None:
    figures = run(tmp_path)
    assert figures.uploads == Counter({503: WRITERS})
    assert figures.codes == Counter({"busy": WRITERS})
    assert set(figures.reads) == {200}
    assert figures.slowest_read < figures.seconds / 4  # no read waited for a writer's turn
    assert figures.afterwards == 202
    assert figures.kept == 2
