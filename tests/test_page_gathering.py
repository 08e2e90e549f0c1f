"""What is dropped or chosen becomes a list of files, whatever folders it lay in."""

from collections.abc import Iterator
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

from tests.browsing import opened
from tests.serving import serving, settings_for

ENTRIES = """
const batch = 100; // no browser hands out more at once
const fileEntry = (path) => ({
  name: path.split("/").at(-1), fullPath: path, isFile: true, isDirectory: false,
  file: (take, refuse) => (path.includes("gone") ? refuse(new Error("gone")) : take(new File(["x"], "x"))),
});
const folderEntry = (path, made) => ({
  name: path.split("/").at(-1), fullPath: path, isFile: false, isDirectory: true,
  createReader() {
    let given = 0;
    return { readEntries: (take) => { take(made.slice(given, given + batch)); given += batch; } };
  },
});
"""


@pytest.fixture(scope="module")
def page(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    with serving(settings_for(tmp_path_factory.mktemp("library"))) as service, opened(browser) as page:
        page.goto(str(service.client.base_url))
        yield page


def gathered(page: Page, entries: str) -> dict[str, Any]:
    """Return the paths that `gather` makes of an expression of entries."""
    return dict(
        page.evaluate(
            f"""async () => {{ {ENTRIES}
              const {{ gather }} = await import("/static/adding/gathering.js");
              const found = await gather({entries});
              return {{ ...found, files: found.files.map(({{ path }}) => path) }};
            }}"""
        )
    )


def test_a_folder_is_read_until_nothing_more_comes(page: Page) -> None:
    many = "Array.from({ length: 1234 }, (_, n) => fileEntry(`/scans/${n}.ply`))"
    found = gathered(page, f'[folderEntry("/scans", {many})]')
    assert found["files"] == [f"scans/{number}.ply" for number in range(1234)]  # in the order people count


def test_folders_in_folders_keep_their_paths(page: Page) -> None:
    deep = (
        'folderEntry("/a/b", [fileEntry("/a/b/c.obj"), folderEntry("/a/b/d", [fileEntry("/a/b/d/e.png")])])'
    )
    assert gathered(page, f'[folderEntry("/a", [{deep}]), fileEntry("/f.ply")]')["files"] == [
        "a/b/c.obj",
        "a/b/d/e.png",
        "f.ply",
    ]


def test_what_systems_add_is_left_out_and_counted(page: Page) -> None:
    hidden = ["/a/.DS_Store", "/a/Thumbs.db", "/a/desktop.ini", "/a/._mesh.ply"]
    entries = ", ".join(f'fileEntry("{path}")' for path in [*hidden, "/a/mesh.ply"])
    folder = 'folderEntry("/a/__MACOSX", [fileEntry("/a/__MACOSX/mesh.ply")])'
    found = gathered(page, f'[folderEntry("/a", [{entries}, {folder}])]')
    assert (found["files"], found["hidden"]) == (["a/mesh.ply"], len(hidden) + 1)


def test_what_cannot_be_read_is_told_and_stops_nothing(page: Page) -> None:
    found = gathered(page, '[folderEntry("/a", [fileEntry("/a/gone.ply"), fileEntry("/a/here.ply")])]')
    assert (found["files"], found["unreadable"]) == (["a/here.ply"], ["/a/gone.ply"])


def test_a_chosen_folder_leaves_out_the_same(page: Page) -> None:
    paths = page.evaluate(
        """async () => {
          const { gatherList } = await import("/static/adding/gathering.js");
          const named = (path) => ({ webkitRelativePath: { value: path } });
          const made = (path) => Object.defineProperties(new File(["x"], "x"), named(path));
          const list = ["a/.git/x.ply", "a/b/mesh.ply", "a/Thumbs.db"].map(made);
          return gatherList(list).files.map(({ path }) => path);
        }"""
    )
    assert paths == ["a/b/mesh.ply"]
