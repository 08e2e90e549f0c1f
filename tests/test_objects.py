"""Plain things are closed where they should be, and coloured."""

import numpy as np
import pytest

from service.samples.objects import THINGS
from service.samples.shell import vertex_normals
from service.samples.variety import GROWN

MAKERS = {**THINGS, **GROWN}


@pytest.mark.parametrize("kind", sorted(MAKERS))
def test_a_thing_looks_outwards(kind: str) -> None:
    shell = MAKERS[kind](np.random.default_rng(4))
    volume = np.linalg.det(shell.vertices[shell.faces]).sum() / 6
    assert volume > 0


@pytest.mark.parametrize("kind", sorted(MAKERS))
def test_a_thing_has_more_than_one_colour(kind: str) -> None:
    shell = MAKERS[kind](np.random.default_rng(4))
    colours = shell.paint(shell.rest, vertex_normals(shell.rest, shell.faces))
    assert colours.shape == shell.rest.shape
    assert len(np.unique(colours.round(1), axis=0)) > 1
