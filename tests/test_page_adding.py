"""Meshes are added from the page: dropped or chosen, refused in words, mended, ready with a picture."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, expect

from service.jobs.describing import describe_files
from tests.accessible import assert_accessible
from tests.browsing import PHONE, opened
from tests.dragging import Drag, write
from tests.pages_of_uploads import REFUSED, choose, row, rows, textured, vase, zipped
from tests.serving import Serving, serving, settings_for, wait_until
from tests.small_library import good_mesh, open_small_library

HOSTILE = "<img src=x onerror=document.title='caught'> ‮ مزهرية"


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    settings = settings_for(tmp_path_factory.mktemp("library"))
    with serving(settings, describe=describe_files, open_library=open_small_library) as running:
        yield running


def test_a_missing_image_is_named_added_and_the_shape_shown(
    service: Serving, browser: Browser, tmp_path: Path
) -> None:
    files = write(tmp_path, vase(1.1))
    with opened(browser, expected=(REFUSED,)) as page:
        page.goto(str(service.client.base_url))
        Drag(page, files / "vase.obj", files / "vase.mtl").drop_to_add()
        expect(row(page, "vase")).to_contain_text("names the image “clay.png”, which was not sent")
        assert_accessible(page)
        choose(page, page.get_by_role("button", name="Add the missing file"), str(files / "clay.png"))
        expect(row(page, "vase")).to_contain_text("ready")
        expect(row(page, "vase").get_by_role("link", name="vase")).to_have_attribute(
            "href", _address(service, "vase")
        )
        picture = row(page, "vase").locator("img")
        expect(picture).to_have_js_property("complete", True)
        assert picture.evaluate("image => image.naturalWidth") > 0
        assert_accessible(page)
    (shape,) = [shape for shape in _shapes(service) if shape["name"] == "vase"]
    assert shape["mesh"]["colour"] == "texture"


def test_a_missing_file_may_be_dropped_onto_its_row(
    service: Serving, browser: Browser, tmp_path: Path
) -> None:
    files = write(tmp_path, vase(1.2))
    with opened(browser, expected=(REFUSED,)) as page:
        page.goto(str(service.client.base_url))
        Drag(page, files / "vase.obj", files / "clay.png").drop_to_add()
        expect(row(page, "vase")).to_contain_text("“vase.mtl”")
        place = row(page, "vase").bounding_box()
        assert place is not None
        # the image of the first drop is remembered: the material file is all that is missing
        Drag(page, files / "vase.mtl").drop(place["x"] + 20, place["y"] + 20)
        expect(row(page, "vase")).to_contain_text("ready")


def test_a_missing_file_may_be_dropped_anywhere(service: Serving, browser: Browser, tmp_path: Path) -> None:
    files = write(tmp_path, vase(1.3))
    with opened(browser, expected=(REFUSED,)) as page:
        page.goto(str(service.client.base_url))
        Drag(page, files / "vase.obj").drop_to_add()
        expect(row(page, "vase")).to_contain_text("A file is missing")
        Drag(page, files / "vase.mtl", files / "clay.png").drop_to_add()
        expect(row(page, "vase")).to_contain_text("ready")


def test_a_file_of_another_name_is_told_so(service: Serving, browser: Browser, tmp_path: Path) -> None:
    files = write(tmp_path, {**vase(1.4), "photo.png": b"no image"})
    with opened(browser, expected=(REFUSED,)) as page:
        page.goto(str(service.client.base_url))
        Drag(page, files / "vase.obj", files / "vase.mtl").drop_to_add()
        choose(page, page.get_by_role("button", name="Add the missing file"), str(files / "photo.png"))
        expect(row(page, "vase")).to_contain_text("The mesh does not name “photo.png”.")


def test_a_mesh_may_go_without_its_texture(service: Serving, browser: Browser, tmp_path: Path) -> None:
    files = write(tmp_path, {"bare.obj": textured(1.5)})
    with opened(browser, expected=(REFUSED,)) as page:
        page.goto(str(service.client.base_url))
        Drag(page, files / "bare.obj").drop_to_add()
        page.get_by_role("button", name="Add without its texture").click()
        expect(row(page, "bare")).to_contain_text("ready")
    (shape,) = [shape for shape in _shapes(service) if shape["name"] == "bare"]
    assert shape["mesh"]["colour"] == "none"


def test_a_folder_gives_a_shape_of_each_mesh_and_tells_what_it_left_out(
    service: Serving, browser: Browser, tmp_path: Path
) -> None:
    shared = {"all.mtl": vase(1)["vase.mtl"], "clay.png": vase(1)["clay.png"]}
    meshes = {
        f"sub/{name}.obj": textured(width, library="../all.mtl")
        for name, width in zip("abc", (2, 3, 4), strict=True)
    }
    more = {"notes.txt": b"x", ".DS_Store": b"x", "front.png": b"x"}
    files = write(
        tmp_path, {f"finds/{name}": content for name, content in {**shared, **meshes, **more}.items()}
    )
    with opened(browser) as page:
        page.goto(str(service.client.base_url))
        Drag(page, files / "finds").drop_to_add()
        expect(page.get_by_role("button", name="3 of 3 ready")).to_be_visible()
        dock = page.get_by_role("complementary")
        expect(dock).to_contain_text("1 file left out, of other kinds: notes.txt")
        expect(dock).to_contain_text("1 file left out, which no mesh names for its colours: front.png")
        expect(dock).to_contain_text("1 file left out: systems add such by themselves")
        page.get_by_role("button", name="Clear finished").click()
        expect(dock).to_be_hidden()
    found = {shape["name"]: {file["name"] for file in shape["files"]} for shape in _shapes(service)}
    assert found["a"] == {"sub/a.obj", "all.mtl", "clay.png"}
    assert {"b", "c"} <= found.keys()


def test_a_hundred_and_twenty_files_are_all_sent_and_the_rows_stay_few(
    browser: Browser, tmp_path: Path
) -> None:
    files = write(tmp_path, {f"many/{number}.ply": good_mesh(number)["good.ply"] for number in range(120)})
    with serving(settings_for(tmp_path / "library", workers=0)) as idle, opened(browser) as page:
        page.goto(str(idle.client.base_url))
        Drag(page, files / "many").drop_to_add()
        expect(page.get_by_text("and 70 others")).to_be_visible()
        wait_until(lambda: len(_shapes(idle)) == 120)
        expect(rows(page).filter(has_text="waiting to be described")).to_have_count(50)


def test_a_zip_is_added_and_a_missing_file_belongs_into_it(
    service: Serving, browser: Browser, tmp_path: Path
) -> None:
    files = write(tmp_path, {"whole.zip": zipped(vase(1.6)), "part.zip": zipped({"part.obj": textured(1.7)})})
    with opened(browser, expected=(REFUSED,)) as page:
        page.goto(str(service.client.base_url))
        Drag(page, files / "whole.zip", files / "part.zip").drop_to_add()
        expect(row(page, "whole")).to_contain_text("ready")
        expect(row(page, "part")).to_contain_text("Put the file into the zip")
        expect(page.get_by_role("button", name="Add the missing file")).to_have_count(0)
        page.get_by_role("button", name="Add without its texture").click()
        expect(row(page, "part")).to_contain_text("ready")


def test_a_file_cut_short_is_refused_in_words(service: Serving, browser: Browser, tmp_path: Path) -> None:
    files = write(tmp_path, {"cut.ply": good_mesh(1)["good.ply"][:-40]})
    with opened(browser, expected=(REFUSED,)) as page:
        page.goto(str(service.client.base_url))
        Drag(page, files / "cut.ply").drop_to_add()
        expect(row(page, "cut")).to_contain_text("The file was cut short.")
        expect(row(page, "cut")).to_contain_text("Copy or export it again")
        expect(page.get_by_role("button", name="0 of 1 ready, 1 refused")).to_be_visible()
        page.get_by_role("button", name="Take off this list: cut").click()
        expect(page.get_by_role("complementary")).to_be_hidden()


def test_what_the_library_has_is_known_by_whatever_way_and_name_it_comes(
    service: Serving, browser: Browser, tmp_path: Path
) -> None:
    service.add({"krater.ply": good_mesh(77)["good.ply"]})
    files = write(tmp_path, {"folder/deep/copy.ply": good_mesh(77)["good.ply"]})
    with opened(browser) as page:
        page.goto(str(service.client.base_url))
        Drag(page, files / "folder").drop_to_add()
        expect(row(page, "copy")).to_contain_text("already in the library as “krater”")
        expect(row(page, "copy").get_by_role("link")).to_have_attribute("href", _address(service, "krater"))


def test_a_name_that_is_code_is_shown_and_not_run(service: Serving, browser: Browser, tmp_path: Path) -> None:
    name = HOSTILE.replace("‮", "")
    files = write(
        tmp_path, {f"{name}.ply": good_mesh(78)["good.ply"], f"{name}.txt": b"x", f"{name}.obj": b"x"}
    )
    with opened(browser, expected=(REFUSED,)) as page:
        page.goto(str(service.client.base_url))
        Drag(page, *files.iterdir()).drop_to_add()
        expect(rows(page).filter(has_text="ready")).to_contain_text(name)
        expect(rows(page).filter(has_text="no OBJ file")).to_contain_text(name)
        expect(page).to_have_title("Faience")


def test_everything_can_be_done_by_keys(service: Serving, browser: Browser, tmp_path: Path) -> None:
    files = write(tmp_path, vase(1.8))
    with opened(browser, expected=(REFUSED,)) as page:
        page.on("filechooser", lambda _: None)  # asked for early: a key may be faster than the asking
        page.goto(str(service.client.base_url))
        page.get_by_role("button", name="Add meshes").focus()
        with page.expect_file_chooser() as chooser:
            page.keyboard.press("Enter")
        chooser.value.set_files([files / "vase.obj", files / "vase.mtl"])
        missing = page.get_by_role("button", name="Add the missing file")
        expect(missing).to_be_visible()
        expect(page.get_by_role("status")).to_have_text("vase is refused: A file is missing")
        while not missing.evaluate("button => button === document.activeElement"):
            page.keyboard.press("Tab")
        with page.expect_file_chooser() as chooser:
            page.keyboard.press("Space")
        chooser.value.set_files(files / "clay.png")
        expect(row(page, "vase")).to_contain_text("ready")
        expect(page.get_by_role("status")).to_have_text("1 of 1 ready")
        fold = page.get_by_role("button", name="1 of 1 ready")
        expect(fold).to_be_focused()  # the button that was pressed is gone
        page.keyboard.press("Enter")
        expect(rows(page)).to_be_hidden()
        expect(fold).to_have_attribute("aria-expanded", "false")


def test_a_phone_has_the_buttons_and_the_whole_width(
    service: Serving, browser: Browser, tmp_path: Path
) -> None:
    files = write(tmp_path, {"cut.ply": good_mesh(1)["good.ply"][:-40], "jug.ply": good_mesh(79)["good.ply"]})
    with opened(browser, PHONE, touch=True, expected=(REFUSED,)) as page:
        page.goto(str(service.client.base_url))
        expect(page.get_by_role("button", name="Add a folder")).to_have_count(0)
        choose(
            page,
            page.get_by_role("button", name="Add meshes"),
            str(files / "cut.ply"),
            str(files / "jug.ply"),
        )
        expect(page.get_by_role("button", name="1 of 2 ready, 1 refused")).to_be_visible()
        assert page.locator("#adding").evaluate("dock => dock.offsetWidth") == PHONE["width"]
        assert page.evaluate("document.documentElement.scrollWidth") == PHONE["width"]
        assert_accessible(page)


def test_the_dock_stays_while_views_change_and_hears_of_removals(
    service: Serving, browser: Browser, tmp_path: Path
) -> None:
    files = write(tmp_path, {"lamp.ply": good_mesh(80)["good.ply"]})
    with opened(browser) as page:
        page.goto(str(service.client.base_url))
        Drag(page, files / "lamp.ply").drop_to_add()
        expect(row(page, "lamp")).to_contain_text("ready")
        page.evaluate("location.hash = '#/?q=lamp'")
        expect(row(page, "lamp")).to_contain_text("ready")
        service.client.delete(_address(service, "lamp").replace("#/", "/v1/"))
        expect(row(page, "lamp")).to_contain_text("removed from the library")


def test_what_fails_only_later_says_why_in_the_same_row(
    service: Serving, browser: Browser, tmp_path: Path
) -> None:
    header, _, body = good_mesh(81)["good.ply"].partition(b"end_header\n")
    files = write(tmp_path, {"late.ply": header + b"end_header\n" + body.replace(b"4 0 2 3 1", b"4 0 2 3 9")})
    with opened(browser) as page:
        page.goto(str(service.client.base_url))
        Drag(page, files / "late.ply").drop_to_add()
        expect(row(page, "late")).to_contain_text("A face names a point that is not there.")
        expect(row(page, "late")).to_contain_text("index_out_of_range")


def test_two_halves_are_offered_while_files_are_held_over_the_page(
    service: Serving, browser: Browser, tmp_path: Path
) -> None:
    files = write(tmp_path, {"urn.ply": good_mesh(82)["good.ply"]})
    with opened(browser) as page:
        page.goto(str(service.client.base_url))
        Drag(page, files / "urn.ply").over(100, 300)
        expect(page.get_by_text("Add to the library")).to_have_class("choice over")
        expect(page.get_by_text("Find what is similar")).to_have_class("choice")
        expect(
            page.get_by_text("Add to the library")
        ).to_be_hidden()  # the drag ended without a drop, unnoticed


def test_a_drop_without_a_mesh_says_what_is_needed(
    service: Serving, browser: Browser, tmp_path: Path
) -> None:
    files = write(tmp_path, {"photo.png": b"x"})
    with opened(browser) as page:
        page.goto(str(service.client.base_url))
        Drag(page, files / "photo.png").drop_to_add()
        expect(page.get_by_role("complementary")).to_contain_text(
            "There is no mesh in it, only photo.png. Add a .ply"
        )


def _shapes(service: Serving) -> list[dict[str, Any]]:
    items: list[dict[str, Any]] = service.client.get("/v1/shapes", params={"limit": 500}).json()["items"]
    return items


def _address(service: Serving, name: str) -> str:
    (found,) = [shape["id"] for shape in _shapes(service) if shape["name"] == name]
    return f"#/shapes/{found}"
