"""The details of a shape: what is known of it, and what can be changed."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, expect
from pydantic import SecretStr

from index.keys import Keys
from index.scopes import Scope
from service.jobs.describing import describe_files
from tests.accessible import assert_accessible
from tests.browsing import PHONE, opened
from tests.serving import Serving, serving, settings_for
from tests.small_library import good_mesh, open_small_library

FLAT = good_mesh(0)["good.ply"].splitlines()
HOSTILE = "<img src=x onerror=alert(1)> خزف"


def flat_mesh() -> dict[str, bytes]:
    """Return a mesh without extent, which only the worker can tell."""
    end = FLAT.index(b"end_header")
    corners = [b"0 0 0 " + b" ".join(line.split()[3:]) for line in FLAT[end + 1 : end + 9]]
    return {"flat.ply": b"\n".join([*FLAT[: end + 1], *corners, *FLAT[end + 9 :], b""])}


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    settings = settings_for(tmp_path_factory.mktemp("library"))
    with serving(settings, describe=describe_files, open_library=open_small_library) as running:
        yield running


@pytest.fixture
def shape(service: Serving) -> Iterator[dict[str, Any]]:
    """Add a shape of its own for each test."""
    metadata = (
        '{"tags": ["vase"], "room": "12 <b>", "on show": true, "loans": ["Paris", 2], "size": {"h": 3}}'
    )
    added = service.add(good_mesh(1), name="amphora", metadata=metadata).json()
    yield added
    service.client.delete(f"/v1/shapes/{added['id']}")


def _open(page: Page, service: Serving, shape: dict[str, Any]) -> None:
    page.goto(f"{service.client.base_url}/#/shapes/{shape['id']}/details")
    expect(page.get_by_role("heading", level=1)).to_have_text(shape["name"])


def test_what_is_known_is_told_in_words(service: Serving, shape: dict[str, Any], browser: Browser) -> None:
    with opened(browser) as page:
        _open(page, service, shape)
        row = page.get_by_role("row")
        expect(row.first).to_contain_text(f"Vertices{shape['mesh']['vertices']}")
        expect(row.filter(has_text="Pieces")).to_contain_text("one")
        expect(row.filter(has_text="Colours")).to_contain_text("from its vertices")
        expect(row.filter(has_text="room")).to_contain_text("12 <b>")
        expect(row.filter(has_text="on show")).to_contain_text("yes")
        expect(row.filter(has_text="loans")).to_contain_text("Paris, 2")
        expect(row.filter(has_text="size")).to_contain_text('{"h":3}')
        expect(row.filter(has_text="tags")).to_have_count(0)
        expect(page.locator("shape-details img")).to_have_js_property("complete", True)
        with page.expect_download() as download:
            page.get_by_role("link", name="good.ply").click()
        assert download.value.suggested_filename == "good.ply"
        assert Path(download.value.path()).read_bytes() == good_mesh(1)["good.ply"]


def test_a_shape_is_renamed_by_the_keyboard(
    service: Serving, shape: dict[str, Any], browser: Browser
) -> None:
    with opened(browser) as page:
        _open(page, service, shape)
        page.get_by_role("button", name="Rename").focus()
        page.keyboard.press("Enter")
        expect(page.get_by_label("Name")).to_be_focused()
        page.keyboard.type("unwanted")
        page.keyboard.press("Escape")
        expect(page.get_by_role("heading", level=1)).to_have_text("amphora")
        expect(page.get_by_role("button", name="Rename")).to_be_focused()
        page.keyboard.press("Enter")
        page.keyboard.type(HOSTILE)
        page.keyboard.press("Enter")
        expect(page.get_by_role("heading", level=1)).to_have_text(HOSTILE)
        expect(page).to_have_title(re.compile(f"^{re.escape(HOSTILE)} . Faience$"))
    assert service.shape(shape["id"])["name"] == HOSTILE
    assert service.shape(shape["id"])["metadata"] == shape["metadata"]


def test_tags_change_and_all_other_metadata_stay(
    service: Serving, shape: dict[str, Any], browser: Browser
) -> None:
    with opened(browser) as page:
        _open(page, service, shape)
        others = {**shape["metadata"], "added by another": 1}
        service.client.patch(f"/v1/shapes/{shape['id']}", json={"metadata": others})
        page.get_by_label("Add a tag").fill(" red figure ")
        page.get_by_role("button", name="Add", exact=True).click()
        expect(page.get_by_role("list", name="Tags").get_by_role("listitem")).to_contain_text(
            ["vase", "red figure"]
        )
        expect(page.get_by_label("Add a tag")).to_have_value("")
        page.get_by_role("button", name="Remove the tag vase").click()
        expect(page.get_by_role("list", name="Tags").get_by_role("listitem")).to_have_count(1)
    assert service.shape(shape["id"])["metadata"] == {**others, "tags": ["red figure"]}


def test_a_shape_is_removed_after_a_question_that_names_it(
    service: Serving, shape: dict[str, Any], browser: Browser
) -> None:
    with opened(browser) as page:
        _open(page, service, shape)
        page.get_by_role("button", name="Remove…").click()
        question = page.get_by_role("dialog", name="Remove “amphora”?")
        expect(question).to_contain_text("This cannot be undone")
        question.get_by_role("button", name="Keep it").click()
        assert service.shape(shape["id"])["name"] == "amphora"
        page.get_by_role("button", name="Remove…").click()
        question.get_by_role("button", name="Remove it").click()
        expect(page).to_have_url(re.compile(r"#/$"))
    assert service.client.get(f"/v1/shapes/{shape['id']}").status_code == 404


def test_a_failed_shape_tells_why_and_is_tried_again(service: Serving, browser: Browser) -> None:
    failed = service.add(flat_mesh(), name="flat").json()
    assert failed["status"] == "failed"
    with opened(browser) as page:
        _open(page, service, failed)
        expect(page.get_by_text(failed["error"]["detail"])).to_be_visible()
        expect(page.locator(".failure")).to_contain_text("zero_area")
        with page.expect_response("**/retry") as answer:
            page.get_by_role("button", name="Try again").click()
        assert answer.value.status == 202
        expect(
            page.get_by_role("heading", name="Why it failed")
        ).to_be_visible()  # once more, told by the stream


def test_what_changes_elsewhere_is_told(service: Serving, shape: dict[str, Any], browser: Browser) -> None:
    with opened(browser) as page:
        with page.expect_response("**/v1/events"):
            _open(page, service, shape)
        service.client.patch(f"/v1/shapes/{shape['id']}", json={"name": "lekythos"})
        expect(page.get_by_role("heading", level=1)).to_have_text("lekythos")
        service.client.delete(f"/v1/shapes/{shape['id']}")
        expect(page.get_by_role("alert")).to_have_text("“lekythos” was removed from the library.")


def test_who_may_only_look_is_told_so_in_the_services_words(tmp_path: Path, browser: Browser) -> None:
    settings = settings_for(tmp_path, api_keys=(SecretStr("first-key"),))
    with serving(settings, describe=describe_files, open_library=open_small_library) as service:
        service.client.headers["authorization"] = "Bearer first-key"
        shape = service.add(good_mesh(2), name="amphora").json()
        secret = Keys(service.library.engine).create("reader", Scope.READ)[1]
        with opened(browser, expected=("403", "401")) as page:
            page.add_init_script(f"sessionStorage.setItem('key', '{secret}')")
            _open(page, service, shape)
            expect(page.locator("shape-details img")).to_have_js_property("complete", True)
            page.get_by_role("button", name="Remove…").click()
            page.get_by_role("button", name="Remove it").click()
            refusal = service.client.delete(
                f"/v1/shapes/{shape['id']}", headers={"authorization": f"Bearer {secret}"}
            ).json()
            expect(page.get_by_role("alert")).to_contain_text(refusal["detail"])
            expect(page.get_by_role("alert")).to_contain_text(refusal["code"])
            with page.expect_download() as download:
                page.get_by_role("link", name="good.ply").click()
            assert Path(download.value.path()).read_bytes() == good_mesh(2)["good.ply"]


@pytest.mark.parametrize("phone", [False, True], ids=["desk", "phone"])
def test_the_details_are_accessible(
    service: Serving, shape: dict[str, Any], browser: Browser, phone: bool
) -> None:
    context = opened(browser, PHONE, touch=True) if phone else opened(browser)
    with context as page:
        _open(page, service, shape)
        assert_accessible(page)
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        page.get_by_role("button", name="Remove…").click()
        assert_accessible(page)


def test_tags_of_any_form_are_read_and_written_alike(service: Serving, browser: Browser) -> None:
    with opened(browser, expected=("404",)) as page:
        page.goto(f"{service.client.base_url}/#/shapes/none")
        tags, added, removed = page.evaluate(
            """async () => {
                const {tagsOf, withTag, withoutTag} = await import("/static/shared/tags.js");
                const held = {tags: [" Vase", "vase", "", 7, "STRASSE"], room: 1};
                return [tagsOf({metadata: held}),
                    [withTag({tags: "one"}, " two "), withTag(held, "straße") === held],
                    [withoutTag(held, "VASE"), withoutTag({tags: "one", room: 1}, "One")]];
            }"""
        )
        assert tags == ["Vase", "STRASSE"]
        assert added == [{"tags": ["one", "two"]}, True]
        assert removed == [{"tags": ["", 7, "STRASSE"], "room": 1}, {"room": 1}]
