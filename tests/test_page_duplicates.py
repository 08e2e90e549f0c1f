"""The page of duplicates: groups side by side with their evidence, and nothing that decides by itself."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, expect

from service.jobs.describing import describe_files
from tests.accessible import assert_accessible
from tests.browsing import PHONE, opened
from tests.copies import HOSTILE, add_copies
from tests.serving import Serving, serving, settings_for
from tests.small_library import open_small_library


@pytest.fixture
def service(tmp_path: Path) -> Iterator[Serving]:
    with serving(settings_for(tmp_path), describe=describe_files, open_library=open_small_library) as running:
        yield running


def show(page: Page, service: Serving, parameters: str = "") -> None:
    page.goto(f"{service.client.base_url}#/duplicates{parameters}")
    expect(page.get_by_role("status")).to_contain_text("found.")
    for image in page.locator(".copy img").all():
        expect(image).to_have_js_property("complete", True)


def groups(service: Serving) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = service.client.get("/v1/duplicates").json()["items"]
    return found


def test_copies_stand_side_by_side_with_what_tells_them_apart(service: Serving, browser: Browser) -> None:
    add_copies(service, 0, "amphora", HOSTILE)
    add_copies(service, 1, "lone")
    with opened(browser) as page:
        show(page, service)
        group = page.get_by_role("article", name="2 shapes: the same shape, exported or meshed anew")
        for name in ("amphora", HOSTILE):
            card = group.get_by_role("listitem").filter(has=page.get_by_role("link", name=name))
            expect(card.locator("dl")).to_contain_text("6")
            expect(card.locator("img")).to_have_js_property("complete", True)
        assert page.get_by_role("article").count() == 1
        expect(page.locator(".looking").get_by_text("Looked at all 3 shapes.")).to_be_visible()
        group.get_by_text("Why the two are together").click()
        expect(group.get_by_text("of the surface is formed otherwise")).to_be_visible()
        assert_accessible(page)


def test_a_dismissal_can_be_undone_where_it_was_made(service: Serving, browser: Browser) -> None:
    add_copies(service, 0, "amphora", "copy")
    with opened(browser) as page:
        show(page, service)
        page.get_by_role("button", name="Not a duplicate").press("Enter")
        expect(page.locator(".decision")).to_contain_text("are no duplicates.")
        assert page.get_by_role("article").count() == 0
        assert groups(service) == []
        expect(page.locator(".decision")).to_be_focused()
        page.keyboard.press("Tab")
        page.keyboard.press("Enter")
        expect(page.get_by_role("article")).to_be_visible()
        expect(page.get_by_role("heading", name="2 shapes")).to_be_focused()
        assert len(groups(service)) == 1


def test_a_shape_that_does_not_belong_leaves_the_others_together(service: Serving, browser: Browser) -> None:
    add_copies(service, 0, "amphora", "copy", "odd one")
    with opened(browser) as page:
        show(page, service)
        page.get_by_role("button", name="Does not belong here (odd one)").click()
        expect(page.get_by_role("heading", name="2 shapes: the same shape")).to_be_visible()
        expect(page.locator(".decision")).to_contain_text("“odd one” does not belong to this group.")
        (left,) = groups(service)
        assert {shape["name"] for shape in left["shapes"]} == {"amphora", "copy"}
        assert len(service.client.get("/v1/duplicates/dismissals").json()["items"]) == 2
        page.get_by_role("button", name="Undo").click()
        expect(page.get_by_role("heading", name="3 shapes: the same shape")).to_be_visible()
        assert service.client.get("/v1/duplicates/dismissals").json()["items"] == []


def test_a_shape_is_removed_only_after_a_question_that_names_it(service: Serving, browser: Browser) -> None:
    _, copy = add_copies(service, 0, "amphora", "copy")
    with opened(browser) as page:
        show(page, service)
        page.get_by_role("button", name="Remove… (copy)").click()
        question = page.get_by_role("dialog", name="Remove “copy”?")
        expect(question.get_by_text("This cannot be undone.")).to_be_visible()
        expect(question.get_by_role("button", name="Keep it")).to_be_focused()
        assert_accessible(page)
        page.keyboard.press("Escape")
        expect(question).to_have_count(0)
        assert service.client.get(f"/v1/shapes/{copy}").status_code == 200
        page.get_by_role("button", name="Remove… (copy)").click()
        question.get_by_role("button", name="Remove it for good").click()
        expect(page.locator(".decision")).to_contain_text("“copy” was removed.")
        assert page.get_by_role("article").count() == 0
        assert service.client.get(f"/v1/shapes/{copy}").status_code == 404


def test_what_is_looked_for_stands_in_the_address(service: Serving, browser: Browser) -> None:
    add_copies(service, 0, "amphora", "copy")
    with opened(browser) as page:
        show(page, service, "?relation=same_file&relation=re_posed")
        expect(page.get_by_text("Each shape was compared")).to_contain_text("same file; re-posed")
        expect(page.get_by_label("Recoloured")).not_to_be_checked()
        page.get_by_label("Same shape").check()
        expect(page.get_by_role("article")).to_be_visible()
        assert "relation=same_shape" in page.url
        for box in page.get_by_role("checkbox").all():
            box.uncheck()
        expect(page.get_by_text("Choose at least one kind of duplicate.")).to_be_visible()


def test_a_shape_that_is_removed_elsewhere_leaves_its_group(service: Serving, browser: Browser) -> None:
    ids = add_copies(service, 0, "amphora", "copy", "third")
    with opened(browser) as page:
        with page.expect_response("**/v1/events"):
            show(page, service)
        expect(page.get_by_role("heading", name="3 shapes")).to_be_visible()
        service.client.delete(f"/v1/shapes/{ids[2]}")
        expect(page.get_by_role("heading", name="2 shapes")).to_be_visible()


def test_an_empty_library_says_what_to_do(service: Serving, browser: Browser) -> None:
    with opened(browser, PHONE) as page:
        show(page, service)
        expect(page.get_by_role("heading", name="There is nothing to compare yet")).to_be_visible()
        assert_accessible(page)
