"""The first run: fill an empty library with the sample creatures and show what a search finds."""

import logging
import time
from collections.abc import Callable, Iterable
from pathlib import Path

from index.shapes import Shape, Status
from service.asking import Question
from service.intake.submissions import receive_paths
from service.library import Library
from service.retrieval import Answer, accept_upload, find_similar
from service.samples import Sample

log = logging.getLogger(__name__)

Report = Callable[[str], None]  # takes a line for the user
MARK = "creature"  # what the metadata of every sample holds
LOOK_EVERY = 0.2  # seconds


def add_samples(library: Library, samples: Iterable[Sample]) -> list[Shape]:
    """Accept every sample; those that are known already stay as they are."""
    shapes = []
    for sample in samples:
        with library.incoming.scratch() as folder:
            paths = {
                name: _written(folder / str(i), data) for i, (name, data) in enumerate(sample.files.items())
            }
            submission = receive_paths(paths, name=sample.name, metadata=dict(sample.metadata))
            shapes.append(accept_upload(library, submission)[0])
    return shapes


def show_samples(
    library: Library, samples: Iterable[Sample], count: int, stopped: Callable[[], bool], report: Report
) -> None:
    """Fill an empty library, wait until all is described, then report one ranked answer; later only that.

    Parameters
    ----------
    count : int
        Samples in all.
    stopped : callable
        Whether to give up, because the service is ending.
    """
    if lacks_samples(library, count):
        report("The library is empty: making the sample creatures and indexing them.")
        shapes = add_samples(library, samples)
    else:
        shapes = _already_here(library, samples)
    if not shapes or not _all_settled(library, stopped):
        return
    answer = find_similar(library, shapes[0].id, Question(limit=5))
    for line in _lines(shapes[0], answer):
        report(line)


def lacks_samples(library: Library, count: int) -> bool:
    """Tell whether there is nothing here but a part of the samples: none, or what a stopped run left."""
    if sum(library.catalogue.counts().values()) >= count:
        return False
    return all(MARK in shape.metadata for shape in library.catalogue.list(limit=count).items)


def _already_here(library: Library, samples: Iterable[Sample]) -> list[Shape]:
    """Return the first sample, if a run before this one kept it."""
    for sample in samples:
        page = library.catalogue.list(limit=1, status=Status.READY, q=sample.name)
        return list(page.items)
    return []


def _written(path: Path, data: bytes) -> Path:
    path.write_bytes(data)
    return path


def _all_settled(library: Library, stopped: Callable[[], bool]) -> bool:
    while not stopped():
        counts = library.catalogue.counts()
        if counts[Status.QUEUED] + counts[Status.PROCESSING] == 0:
            return True
        time.sleep(LOOK_EVERY)
    return False


def _lines(shape: Shape, answer: Answer) -> list[str]:
    title = f"Nearest to {shape.name!r} by {answer.method} ({answer.milliseconds:.0f} ms):"
    return [title, *(f"{hit.rank:4d}  {hit.distance:8.3f}  {hit.shape.name}" for hit in answer.hits)]
