"""Only what nobody needs is swept."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from service.intake.submissions import receive_paths
from service.jobs.sweeping import sweep
from service.library import Library
from service.retrieval import accept_upload
from tests.fakes import coloured_triangle
from tests.serving import open_fake_library, settings_for
from tests.storages import on_disk, only_folders

pytestmark = pytest.mark.usefixtures("kept")  # on SQLite and on PostgreSQL, and with files in a bucket


@pytest.fixture
def library(tmp_path: Path) -> Iterator[Library]:
    opened = open_fake_library(settings_for(tmp_path / "library"))
    yield opened
    opened.close()


def test_orphans_go_and_everything_that_a_shape_needs_stays(library: Library, tmp_path: Path) -> None:
    path = tmp_path / "a.ply"
    path.write_bytes(coloured_triangle())
    shape, _ = accept_upload(library, receive_paths({"a.ply": path}))
    library.files.put(f"shapes/{shape.id}/thumbnail.png", b"x")
    needed = set(library.files.keys())
    library.files.put("uploads/killed/0", b"never got a row")
    library.files.put("shapes/removed/preview.glb", b"its row is gone")
    assert sweep(library, older_than=0) == 2
    assert set(library.files.keys()) == needed


def test_young_files_may_belong_to_an_upload_under_way(library: Library) -> None:
    library.files.put("uploads/under-way/0", b"its row follows")
    assert sweep(library) == 0
    assert list(library.files.keys()) == ["uploads/under-way/0"]


@only_folders
def test_what_file_managers_leave_behind_stops_no_sweep_and_is_left_alone(library: Library) -> None:
    library.files.put("uploads/killed/0", b"never got a row")
    strange = on_disk(library.files).path("uploads") / ".DS_Store"
    strange.write_bytes(b"of a file manager")
    assert sweep(library, older_than=0) == 1
    assert strange.exists()
    assert list(library.files.keys()) == []
