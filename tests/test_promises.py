"""Every kind of broken promise is seen: the inspection that crash tests end with can fail."""

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from sqlalchemy import select, update

from index.database import writing
from index.tables import QuantisedBlockRow, ShapeRow
from service.commands.opening import working
from service.intake.submissions import receive_paths
from service.library import Library
from service.retrieval import accept_upload
from service.settings import Settings
from service.storage import THUMBNAIL, derived_key
from soak.ledger import Ledger
from soak.parcels import parcel
from soak.processes import wait_until
from soak.promises import broken_promises

NUMBERS = (1, 3, 8)  # an OBJ with its picture, a coloured PLY, one without a surface


def accept(library: Library, number: int) -> str:
    with library.incoming.scratch() as folder:
        paths = {name: folder / name for name in parcel(number)}
        for name, content in parcel(number).items():
            paths[name].write_bytes(content)
        return accept_upload(library, receive_paths(paths))[0].id


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[int, str]]:
    """Return a library in which all is well, and the ids by number."""
    folder = tmp_path_factory.mktemp("whole") / "library"
    library = Library.open(Settings(data_dir=folder, poll_seconds=0.05, workers=1))
    ids = {number: accept(library, number) for number in NUMBERS}
    with working(library):
        wait_until(lambda: {shape.status for shape in library.catalogue.list().items} == {"ready", "failed"})
    library.close()
    return folder, ids


@pytest.fixture
def broken(whole: tuple[Path, dict[int, str]], tmp_path: Path) -> Iterator["Broken"]:
    """Lend a copy to be broken."""
    folder, ids = whole
    shutil.copytree(folder, tmp_path / "library")
    library = Library.open(Settings(data_dir=tmp_path / "library"))
    yield Broken(library, ids)
    library.close()


class Broken:
    """A library, and what was promised of it."""

    def __init__(self, library: Library, ids: dict[int, str]) -> None:
        self.library, self.ids, self.ledger = library, ids, Ledger()
        for number, shape_id in ids.items():
            self.ledger.acknowledge(shape_id, number)

    def change(self, number: int, **values: str) -> None:
        """Change a row behind the catalogue's back."""
        with writing(self.library.engine) as session:
            session.execute(update(ShapeRow).where(ShapeRow.id == self.ids[number]).values(**values))

    def told(self) -> str:
        """Return what the inspection says, as one text."""
        return "\n".join(broken_promises(self.library.settings.data_dir, self.ledger))


def test_where_all_is_well_nothing_is_told(broken: Broken) -> None:
    assert broken.told() == ""


def lose(broken: Broken) -> None:
    broken.library.catalogue.remove(broken.ids[3])


def alter(broken: Broken) -> None:
    key = broken.library.catalogue.get(broken.ids[3]).files[0].key
    broken.library.files.put(key, broken.library.files.get(key).replace(b"ply", b"plx"))


def lose_a_file(broken: Broken) -> None:
    broken.library.files.delete(broken.library.catalogue.get(broken.ids[3]).files[0].key)


def lose_a_picture(broken: Broken) -> None:
    broken.library.files.delete(derived_key(broken.ids[3], THUMBNAIL))


def leave_a_file(broken: Broken) -> None:
    broken.library.files.put("elsewhere/0", b"left")


def leave_an_upload(broken: Broken) -> None:
    (broken.library.incoming.folder / "half").write_bytes(b"left")


def bring_back(broken: Broken) -> None:
    broken.ledger.remove(broken.ids[3], told=True)


def double(broken: Broken) -> None:
    broken.change(1, name="3")


def invent(broken: Broken) -> None:
    broken.change(3, name="77")


def hang(broken: Broken) -> None:
    broken.change(3, status="processing")


def answer_with_a_defect(broken: Broken) -> None:
    broken.ledger.note("list", 500, frozenset({200}))


def mix_two_up(broken: Broken) -> None:
    broken.ledger.acknowledge(broken.ids[3], 1)


def let_the_index_go_stale(broken: Broken) -> None:
    """Exchange the numbers of two shapes after the index was saved, without a new revision."""
    vocabulary = broken.library.catalogue.state().vocabulary_id
    rows = dict(broken.library.catalogue.block_rows(vocabulary))
    broken.library.searcher.search("hks", rows[broken.ids[1]], 2)
    broken.library.searcher.save()
    wanted = select(QuantisedBlockRow).where(QuantisedBlockRow.name == "hks-0")
    with writing(broken.library.engine) as session:
        one, other = session.scalars(wanted).all()
        one.data, other.data = other.data, one.data


@pytest.mark.parametrize(
    ("breaking", "told"),
    [
        (lose, "is gone"),
        (alter, "is not what was sent"),
        (lose_a_file, "is missing"),
        (lose_a_picture, "is missing"),
        (leave_a_file, "belongs to nobody"),
        (leave_an_upload, "was left of an upload"),
        (bring_back, "was removed and is back"),
        (double, "is kept 2 times"),
        (invent, "nobody sent 77"),
        (hang, "is processing"),
        (answer_with_a_defect, "was answered with 500"),
        (mix_two_up, "were told to be one shape"),
        (let_the_index_go_stale, "which brute force does not"),
    ],
)
def test_a_broken_promise_is_told(broken: Broken, breaking: Callable[[Broken], None], told: str) -> None:
    breaking(broken)
    assert told in broken.told()
