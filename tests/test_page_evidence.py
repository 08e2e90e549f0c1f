"""The numbers of a relation, in words: with the limits by which the service decides."""

from collections.abc import Iterator
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

from service.relations import deciding
from tests.modules import modules

SAY = "async (relation) => (await import('/static/shared/evidence.js')).evidenceOf(relation)"
NUMBERS: dict[str, Any] = {
    "name": "recoloured",
    "shape_distance": 0.012,
    "colour_distance": 0.9255,
    "pattern_distance": 0.7,
    "pose_distance": 0.0,
    "misfit": 3e-14,
    "part": None,
}


@pytest.fixture(scope="module")
def page(browser: Browser) -> Iterator[Page]:
    with modules(browser) as page:
        yield page


def test_the_limits_are_those_of_the_service(page: Page) -> None:
    limits = page.evaluate("async () => (await import('/static/shared/evidence.js')).LIMITS")
    assert limits == {
        "shape": deciding.SHAPE,
        "colour": deciding.COLOUR,
        "pattern": deciding.PATTERN,
        "pose": deciding.POSE,
        "fits": deciding.FITS,
        "bent": deciding.BENT,
        "part": deciding.PART_FITS,
    }


def test_shares_are_per_cent_and_lengths_centimetres(page: Page) -> None:
    shape, colours, places, pose, misfit, unit = page.evaluate(SAY, NUMBERS)
    assert "1.2% of the surface" in shape
    assert "93% of the surface" in colours
    assert "70%" in places
    assert " 0 cm on average" in pose
    assert "less than 0.01 cm apart" in misfit
    assert "as large as a person" in unit


def test_what_decides_nothing_is_not_told(page: Page) -> None:
    told = page.evaluate(SAY, NUMBERS | {"pose_distance": None, "misfit": None})
    assert len(told) == 3
    assert not any("cm" in sentence for sentence in told)
    assert len(page.evaluate(SAY, NUMBERS | {"name": "same_file"})) == 1


def test_a_part_is_held_against_its_own_limit(page: Page) -> None:
    *_, cut, _ = page.evaluate(SAY, NUMBERS | {"name": "part_of", "part": "query", "misfit": 0.4})
    assert "within 0.4 cm of the larger one. Up to 1.3 cm" in cut
