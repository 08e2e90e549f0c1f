"""Placing: where on two surfaces the difference of a block lies."""

import numpy as np

from index.methods import Method
from index.vocabulary import Vocabulary
from service.why.errors import NotExplained
from service.why.sides import Side
from worker.arrays import FloatArray
from worker.descriptors.contributions import cell_densities, curve_densities, word_densities

HISTOGRAM, CURVES = "colour-histogram", "colour-curves"
NOWHERE = {
    "diffusion-geometric": "the distances between all pairs of points",
    "diffusion-joint": "the distances between all pairs of points",
    "meshhog": "single features of the colours",
}  # blocks without places on the surface, and what they compare


def check_places(method: Method) -> None:
    """Refuse a method whose blocks have no places on the surface.

    Raises
    ------
    NotExplained
    """
    for block in method.blocks:
        if block.weight and block.name in NOWHERE:
            raise NotExplained(
                f"the method {method.name!r} compares {NOWHERE[block.name]}, which belong to no one place on "
                "the surface, so nothing can be coloured; choose another method"
            )


def difference(one: Side, other: Side, name: str) -> FloatArray:
    """Return by how much each number of a block is greater on one side than on the other; (k,)."""
    return np.asarray(one.blocks[name], np.float64) - np.asarray(other.blocks[name], np.float64)


def densities(own: Side, other: Side, name: str, vocabulary: Vocabulary) -> FloatArray:
    """Return what each vertex of one side adds to the L1 distance of a block, per share of its area; (n,)."""
    surplus = np.maximum(difference(own, other, name), 0.0)
    if name == HISTOGRAM:
        held = np.asarray(own.blocks[name], np.float64)
        return cell_densities(own.lab, own.shares, held, surplus, own.parameters)
    if name == CURVES:
        half = np.abs(difference(own, other, name)).sum() / 2.0
        return curve_densities(own.orders, own.lab, own.shares, own.curves, other.curves, float(half))
    words = vocabulary.words[name]
    standardised = (own.signature(name) - words.centre) / words.spread
    return word_densities(standardised, own.shares, words.words, words.softness, surplus)
