"""The ranked answer: the query, and what is similar to it."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Route, expect

from service.jobs.describing import describe_files
from tests.accessible import assert_accessible
from tests.answering import (
    BLUE,
    CUBE,
    HOSTILE,
    RED,
    TOWER,
    add,
    answer_of,
    answering,
    block,
    blocks_served,
    names,
)
from tests.browsing import DESK, PHONE
from tests.serving import Serving, serving, settings_for
from tests.small_library import open_small_library

PLACES = "cards => cards.map((card) => JSON.stringify(card.getBoundingClientRect()))"


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Serving, str]]:
    with blocks_served(tmp_path_factory.mktemp("library")) as served:
        yield served


def test_from_the_library_a_shape_leads_to_what_is_similar(
    library: tuple[Serving, str], browser: Browser
) -> None:
    with answer_of(library[0], "/", browser) as page:
        page.get_by_role("link", name="red cube").click()
        expect(page.get_by_role("heading", name="red cube", level=1)).to_be_visible()
        expect(page.locator(".result")).to_have_count(3)
        expect(page.locator(".result .rank")).to_have_text(["1", "2", "3"])
        widths = [float(bar.get_attribute("width") or 0) for bar in page.locator(".result rect").all()]
        assert widths == sorted(widths)
        assert widths[-1] == 100


def test_relations_fill_in_later_and_nothing_moves(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library
    held: list[Route] = []
    with answer_of(service, "/", browser) as page:
        page.route("**/similar?*relations=true*", lambda route: held.append(route))
        page.evaluate(f"location.hash = '#/shapes/{query}'")
        expect(page.locator(".result")).to_have_count(3)
        page.wait_for_timeout(200)
        places = page.locator(".result").evaluate_all(PLACES)
        while not held:
            page.wait_for_timeout(20)
        held[0].continue_()
        expect(page.locator(".result", has_text="blue cube").locator(".relation button")).to_have_text(
            "recoloured"
        )
        assert page.locator(".result").evaluate_all(PLACES) == places


def test_a_relation_gives_its_evidence_when_asked(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}", browser) as page:
        related = page.locator(".result", has_text="blue cube").locator(".relation button")
        related.press("Enter")
        evidence = page.get_by_text("of the surface has colours that the other lacks").locator("visible=true")
        expect(evidence).to_have_count(1)
        page.keyboard.press("Escape")
        expect(evidence).to_have_count(0)
        expect(related).to_be_focused()


def test_a_result_becomes_the_query_and_keeps_how_to_compare(
    library: tuple[Serving, str], browser: Browser
) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}?colour=0", browser) as page:
        page.get_by_role("link", name="What is similar to blue cube").click()
        expect(page.get_by_role("heading", name="blue cube", level=1)).to_be_visible()
        expect(page.get_by_role("slider")).to_have_value("0")
        expect(page.locator(".result .name").first).to_have_text("red cube")
        page.go_back()
        expect(page.get_by_role("heading", name="red cube", level=1)).to_be_visible()


def test_a_hostile_name_is_text(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library
    with answer_of(service, f"/#/shapes/{query}", browser) as page:
        expect(page.get_by_text(HOSTILE)).to_be_visible()
        page.get_by_role("link", name=f"What is similar to {HOSTILE}").click()
        expect(page.get_by_role("heading", name=HOSTILE)).to_be_visible()


@pytest.mark.parametrize("phone", [False, True])
def test_everybody_can_read_it(library: tuple[Serving, str], browser: Browser, phone: bool) -> None:
    service, query = library
    viewport = PHONE if phone else DESK
    with answer_of(service, f"/#/shapes/{query}", browser, viewport, touch=phone) as page:
        expect(page.locator(".relation button")).to_have_count(3)
        assert_accessible(page)
        wide = page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
        assert wide == 0


def test_alone_in_the_library_it_says_so_and_waits_for_none(
    tmp_path_factory: pytest.TempPathFactory, browser: Browser
) -> None:
    settings = settings_for(tmp_path_factory.mktemp("alone"))
    with serving(settings, describe=describe_files, open_library=open_small_library) as service:
        query = add(service, block(CUBE, RED), "lonely")
        with answer_of(service, f"/#/shapes/{query}", browser) as page:
            expect(page.get_by_text("the library holds no other shape")).to_be_visible()


def test_more_results_come_when_asked(tmp_path_factory: pytest.TempPathFactory, browser: Browser) -> None:
    settings = settings_for(tmp_path_factory.mktemp("many"))
    with serving(settings, describe=describe_files, open_library=open_small_library) as service:
        query = add(service, block(CUBE, RED), "first")
        for seed in range(1, 27):
            add(service, block(CUBE, BLUE, seed), f"other {seed}")
        with answer_of(service, f"/#/shapes/{query}", browser) as page:
            expect(page.locator(".result")).to_have_count(24)
            page.get_by_role("button", name="Show more").click()
            expect(page.locator(".result")).to_have_count(26)
            expect(page.get_by_role("button", name="Show more")).to_have_count(0)


def test_a_shape_that_waits_is_answered_as_soon_as_it_is_ready(
    library: tuple[Serving, str], browser: Browser
) -> None:
    service, query = library
    waiting = {**service.shape(query), "status": "processing", "mesh": None}
    with answer_of(service, "/", browser) as page:
        page.route(
            f"**/v1/shapes/{query}", answering(waiting), times=2
        )  # on arrival, and as the stream begins
        page.evaluate(f"location.hash = '#/shapes/{query}'")
        expect(page.get_by_role("heading", name="It is being described")).to_be_visible()
        service.client.patch(f"/v1/shapes/{query}", json={"metadata": {"seen": "yes"}})  # the stream tells
        expect(page.locator(".result")).to_have_count(3)


def test_a_shape_that_failed_says_why(library: tuple[Serving, str], browser: Browser) -> None:
    service, query = library
    error = {"code": "too_complex", "detail": "It has more faces than fit."}
    failed = {**service.shape(query), "status": "failed", "mesh": None, "error": error}
    with answer_of(service, "/", browser) as page:
        page.route(f"**/v1/shapes/{query}", answering(failed))
        page.evaluate(f"location.hash = '#/shapes/{query}'")
        expect(page.get_by_role("alert")).to_have_text("It has more faces than fit. (too_complex)")


def test_a_mesh_that_was_dropped_is_a_query_like_a_shape(
    library: tuple[Serving, str], browser: Browser
) -> None:
    service, _ = library
    parts = [("files", file) for file in block(CUBE, RED, 9).items()]
    sent = service.client.post("/v1/search", params={"remember": "true"}, files=parts)
    query = sent.json()["query"]
    with answer_of(service, f"/#/queries/{query['id']}?colour=0", browser) as page:
        expect(page.get_by_role("heading", name=query["name"], level=1)).to_be_visible()
        expect(page.get_by_text("Not in the library")).to_be_visible()
        expect(page.get_by_text("Name, tags and files")).to_have_count(0)
        expect(page.locator(".result")).to_have_count(4)
        assert set(names(page)[:2]) == {"red cube", "blue cube"}


def test_a_forgotten_mesh_is_explained(library: tuple[Serving, str], browser: Browser) -> None:
    with answer_of(library[0], "/#/queries/old", browser, expected=("404",)) as page:
        expect(
            page.get_by_text("This search was forgotten after an hour; drop the mesh again.")
        ).to_be_visible()


def test_the_query_is_renamed_below_its_picture(library: tuple[Serving, str], browser: Browser) -> None:
    service, _ = library
    query = add(service, block(TOWER, BLUE, 8), "nameless")
    with answer_of(service, f"/#/shapes/{query}", browser) as page:
        expect(page.get_by_role("button", name="Rename")).to_have_count(0)
        page.get_by_text("Name, tags and files").click()
        page.get_by_role("button", name="Rename").click()
        page.get_by_role("textbox", name="Name").fill("obelisk")
        page.keyboard.press("Enter")
        expect(page.get_by_role("heading", name="obelisk", level=1)).to_be_visible()
        assert_accessible(page)
    service.client.delete(f"/v1/shapes/{query}")
