"""A side is made of a preview whose vertices its signatures belong to, or not at all."""

import numpy as np
import pytest

from index.errors import BadBlock
from service.why.errors import NotExplained
from service.why.sides import Side, side_of
from tests.painted import ORANGE, described, side
from tests.shapes import sphere
from worker.arrays import SingleArray
from worker.parameters import Parameters
from worker.pictures.preview import preview

BLOCKS = ("colour-histogram", "colour-curves")


def made(glb: bytes, **signatures: SingleArray) -> Side:
    known = described(ORANGE)
    return side_of(known.blocks, {**known.signatures, **signatures}, glb, BLOCKS, Parameters())


def test_curves_of_the_preview_are_those_of_the_description() -> None:
    own = side(ORANGE)
    # Colours come back in 8 linear bits, coarse where they are dark.
    mean, kept = own.curves.mean(axis=(0, 1)), np.asarray(own.blocks["colour-curves"]).reshape(3, 16, 3)
    assert np.corrcoef((own.curves - mean)[..., 0].ravel(), kept[..., 0].ravel())[0, 1] > 0.999
    assert own.shares.sum() == pytest.approx(1.0)


def test_a_preview_of_other_vertices_is_refused() -> None:
    vertices, faces = sphere(3)
    glb = preview(vertices, faces, np.full(vertices.shape, 0.5))
    with pytest.raises(NotExplained, match="small pieces"):
        made(glb)


def test_a_preview_of_as_many_vertices_in_another_order_is_refused() -> None:
    own = side(ORANGE)
    turned = np.random.default_rng(0).permutation(len(own.vertices))
    places = np.argsort(turned)
    glb = preview(own.vertices[turned], places[own.faces], np.full(own.vertices.shape, 0.5))
    with pytest.raises(NotExplained):
        made(glb)


def test_a_preview_that_cannot_be_read_is_refused() -> None:
    with pytest.raises(NotExplained, match="cannot be read"):
        made(b"glTF")


def test_a_description_of_an_earlier_version_is_refused() -> None:
    known = described(ORANGE)
    with pytest.raises(BadBlock, match="no-such-block"):
        side_of(known.blocks, known.signatures, known.preview, ("no-such-block",), Parameters())
    without = {name: values for name, values in known.signatures.items() if name != "hks-0"}
    early = side_of(known.blocks, without, known.preview, BLOCKS, Parameters())
    with pytest.raises(BadBlock, match="hks-0"):
        _ = early.curves
