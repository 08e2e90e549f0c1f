"""A library looked at from outside, after all that was done to it: which promises were broken."""

import random
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from index.errors import FileMissing
from index.methods import METHODS
from index.ranking import Ranked
from index.shapes import Shape, Status
from service.jobs.recording import GAVE_UP
from service.jobs.sweeping import sweep
from service.library import Library
from service.settings import Settings
from service.storage import PREVIEW, SIGNATURES, THUMBNAIL, derived_key
from soak.ledger import Ledger
from soak.parcels import EMPTY, kind_of, parcel
from tests.brute_force import distance

QUERIES = 5  # compared with every shape, for each method
NEAREST = 10  # answers compared


def broken_promises(folder: Path, ledger: Ledger) -> list[str]:
    """Return what is not as it was promised; the service does not run meanwhile.

    Parameters
    ----------
    folder : Path
        The library's; every job in it has ended.
    """
    library = Library.open(Settings(data_dir=folder))
    try:
        shapes = {shape.id: shape for shape in _all_shapes(library)}
        sweep(library, older_than=0)
        return [
            *ledger.surprises,
            *_lost_or_doubled(library, ledger, shapes),
            *_unended(shapes),
            *_files_out_of_step(library, shapes),
            *_answers_beside_brute_force(library, shapes),
        ]
    finally:
        library.close()


def _all_shapes(library: Library) -> Iterator[Shape]:
    cursor = None
    while True:
        page = library.catalogue.list(limit=500, cursor=cursor)
        yield from page.items
        cursor = page.next_cursor
        if cursor is None:
            return


def _lost_or_doubled(library: Library, ledger: Ledger, shapes: dict[str, Shape]) -> Iterator[str]:
    for shape_id, number in ledger.standing().items():
        if shape_id not in shapes:
            yield f"parcel {number} was acknowledged as {shape_id} and is gone"
            continue
        kept = {file.name: _content(library, file.key) for file in shapes[shape_id].files}
        if kept != parcel(number):
            yield f"parcel {number}, kept as {shape_id}, is not what was sent"
    yield from (f"{shape_id} was removed and is back" for shape_id in ledger.removed & shapes.keys())
    names = Counter(shape.name for shape in shapes.values())
    yield from (f"parcel {name} is kept {count} times" for name, count in names.items() if count > 1)
    sent = {str(number) for number in {*ledger.acknowledged.values(), *ledger.unanswered}}
    yield from (f"nobody sent {name}" for name in names.keys() - sent)


def _content(library: Library, key: str) -> bytes | None:
    try:
        return library.files.get(key)
    except FileMissing:
        return None


def _unended(shapes: dict[str, Shape]) -> Iterator[str]:
    for shape in shapes.values():
        empty = kind_of(int(shape.name)) == "empty"
        good = (Status.FAILED, EMPTY) if empty else (Status.READY, None)
        if (shape.status, shape.error_code) not in (good, (Status.FAILED, GAVE_UP)):
            yield f"parcel {shape.name} is {shape.status} ({shape.error_code}), expected {good}"


def _files_out_of_step(library: Library, shapes: dict[str, Shape]) -> Iterator[str]:
    needed = {file.key for shape in shapes.values() for file in shape.files}
    made = {
        derived_key(shape.id, name, shape.made_in)
        for shape in shapes.values()
        if shape.status == Status.READY
        for name in (THUMBNAIL, PREVIEW, SIGNATURES)
    }
    found = set(library.files.keys())
    yield from (f"{key} is missing" for key in (needed | made) - found)
    allowed = {
        key for shape_id in shapes for key in library.files.keys(f"shapes/{shape_id}")
    }  # of a failed one
    yield from (f"{key} belongs to nobody" for key in found - needed - made - allowed)
    waiting = [path for path in library.incoming.folder.parent.glob("*/*") if path.name != ".lock"]
    yield from (f"{path.name} was left of an upload" for path in waiting)


def _answers_beside_brute_force(library: Library, shapes: dict[str, Shape]) -> Iterator[str]:
    ready = sorted(shape.id for shape in shapes.values() if shape.status == Status.READY)
    state = library.catalogue.state()
    for name, method in METHODS.items():
        blocks = [block.name for block in method.blocks]
        rows = dict(library.catalogue.block_rows(state.vocabulary_id, 0, blocks))
        if sorted(rows) != ready:
            yield f"{name}: {len(rows)} shapes have their numbers, {len(ready)} are ready"
        for query in random.Random(name).sample(ready, min(QUERIES, len(ready))):
            slow = {id_: distance(method, rows[query], row) for id_, row in rows.items()}
            quick = library.searcher.search(name, rows[query], NEAREST)
            if not _same_answer(quick, slow):
                yield f"{name}: the index answers {quick} to {query}, which brute force does not"


def _same_answer(quick: Ranked, slow: dict[str, float]) -> bool:
    """Compare but for the order of what is equally far, to the last digits of a sum."""
    nearest = sorted(slow.values())[:NEAREST]
    return (
        len({id_ for id_, _ in quick}) == len(nearest)
        and np.allclose([found for _, found in quick], nearest, rtol=1e-9, atol=1e-9)
        and np.allclose([slow.get(id_, np.inf) for id_, _ in quick], nearest, rtol=1e-9, atol=1e-9)
    )
