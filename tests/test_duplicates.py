"""Duplicates: each group comes once, page by page, whatever is dismissed stays away, nothing is removed."""

from collections.abc import Iterator
from itertools import combinations
from pathlib import Path

import pytest

from index.errors import BadCursor
from service.backup.exporting import export_library
from service.backup.importing import import_library
from service.intake.submissions import receive_paths
from service.jobs.recording import record_description
from service.library import Library
from service.relations.duplicates import Duplicates, Kind, find_duplicates
from service.relations.relation import Relation
from service.retrieval import accept_upload, remove_shape
from tests.backups import claimed, opened
from tests.fakes import coloured_triangle, fake_description
from worker.reading.upload import Upload, read_mesh

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL

ONE, OTHER = coloured_triangle(200, 100, 50), coloured_triangle(200, 100, 250)  # in two colours
FAR = coloured_triangle(20, 100, 50)  # fake descriptions take the shape from red


def exported_anew(ply: bytes, number: int) -> bytes:
    """Return the same mesh in a file that differs."""
    return ply.replace(b"ply\n", b"ply\ncomment copy %d\n" % number, 1)


def add(library: Library, name: str, ply: bytes) -> str:
    """Keep and describe a mesh; the folder makes the same file another upload."""
    with library.incoming.scratch() as folder:
        path = folder / "mesh.ply"
        path.write_bytes(ply)
        shape, _ = accept_upload(library, receive_paths({f"{name}/mesh.ply": path}, name=name))
    mesh = read_mesh(Upload(files={"mesh.ply": ply}))
    record_description(library, claimed(library), fake_description(mesh, library.parameters))
    return shape.id


@pytest.fixture
def library(tmp_path: Path) -> Iterator[Library]:
    with opened(tmp_path / "library") as library:
        yield library


def every(
    library: Library, limit: int = 20, work: int = 100, **changes: tuple[Kind, ...]
) -> list[Duplicates]:
    found: list[Duplicates] = []
    cursor: str | None = None
    while True:
        page = find_duplicates(library, limit=limit, cursor=cursor, work=work, **changes)
        found += page.items
        cursor = page.next_cursor
        if cursor is None:
            return found


def named(found: list[Duplicates]) -> dict[frozenset[str], Relation]:
    return {frozenset(shape.name for shape in each.shapes): each.group.relation for each in found}


def test_an_empty_library_has_none(library: Library) -> None:
    assert find_duplicates(library).items == ()
    assert find_duplicates(library).next_cursor is None


def test_each_relation_makes_a_group(library: Library) -> None:
    for name, ply in {"a": FAR, "b": FAR, "c": ONE, "d": coloured_triangle(90, 90, 90)}.items():
        add(library, name, ply)
    add(library, "e", exported_anew(ONE, 1))
    assert named(every(library)) == {
        frozenset("ab"): Relation.SAME_FILE,
        frozenset("ce"): Relation.SAME_SHAPE,
    }


def test_recoloured_copies_are_joined_unless_only_the_same_colours_are_wanted(library: Library) -> None:
    for name, ply in {"a": ONE, "b": OTHER, "c": exported_anew(ONE, 1)}.items():
        add(library, name, ply)
    assert named(every(library)) == {frozenset("abc"): Relation.RECOLOURED}
    same = every(library, relations=(Relation.SAME_SHAPE,))
    assert named(same) == {frozenset("ac"): Relation.SAME_SHAPE}


@pytest.mark.parametrize(("limit", "work"), [(1, 100), (2, 3), (20, 1), (20, 100)])
def test_pages_give_each_group_once(library: Library, limit: int, work: int) -> None:
    wanted = set()
    for level in (10, 70, 130, 190):
        names = [f"{level} {number}" for number in range(3)]
        for number, name in enumerate(names):
            add(library, name, exported_anew(coloured_triangle(level), number))
        wanted.add(frozenset(names))
    found = every(library, limit=limit, work=work)
    assert len(found) == len(wanted)
    assert named(found).keys() == wanted
    ids = [each.group.id for each in found]
    assert ids == [each.group.id for each in every(library)]


def test_a_page_looks_at_no_more_shapes_than_it_may(library: Library) -> None:
    for number in range(6):
        add(library, f"{number}", coloured_triangle(40 * number))
    first = find_duplicates(library, work=2)
    assert (first.items, first.next_cursor is None) == ((), False)


def test_a_dismissed_pair_never_comes_back(library: Library, tmp_path: Path) -> None:
    a, b = add(library, "a", ONE), add(library, "b", exported_anew(ONE, 1))
    library.catalogue.dismiss(b, a)
    assert every(library) == []
    export_library(library, tmp_path / "library.tar")
    with opened(tmp_path / "other") as other:
        import_library(other, tmp_path / "library.tar")
        assert every(other) == []
    with opened(tmp_path / "other") as again:
        assert every(again) == []
        again.catalogue.undismiss(a, b)
        assert named(every(again)) == {frozenset("ab"): Relation.SAME_SHAPE}


def test_a_dismissed_pair_is_in_no_group_by_way_of_a_third(library: Library) -> None:
    ids = {name: add(library, name, exported_anew(ONE, number)) for number, name in enumerate("abc")}
    library.catalogue.dismiss(ids["a"], ids["b"])
    found = named(every(library)).keys()
    assert found == {frozenset("ac"), frozenset("bc")}


def test_looking_removes_nothing_and_a_removed_copy_is_gone_from_its_group(library: Library) -> None:
    ids = [add(library, name, exported_anew(ONE, number)) for number, name in enumerate("abc")]
    before = library.catalogue.revision()
    assert named(every(library)).keys() == {frozenset("abc")}
    assert library.catalogue.revision() == before
    remove_shape(library, ids[0])
    assert named(every(library)).keys() == {frozenset("bc")}


def test_pairs_tell_what_joins_the_shapes_of_a_group(library: Library) -> None:
    ids = sorted(add(library, name, exported_anew(ONE, number)) for number, name in enumerate("abc"))
    (found,) = every(library)
    assert found.group.members == tuple(ids) == tuple(shape.id for shape in found.shapes)
    assert set(found.group.pairs) == set(combinations(ids, 2))


@pytest.mark.parametrize(
    "cursor", ["", "é", "YWJj", "YWZ0ZXI6eA==", "ZnJvbTo="]
)  # … "abc", "after:x", "from:"
def test_a_cursor_from_elsewhere_is_refused(library: Library, cursor: str) -> None:
    with pytest.raises(BadCursor):
        find_duplicates(library, cursor=cursor)
