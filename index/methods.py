"""Methods: which blocks a search compares, and how much each of them counts. One table."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum

from index.errors import BadWeights, UnknownMethod


class LooksAt(StrEnum):
    """What a block tells of a shape."""

    GEOMETRY = "geometry"
    COLOUR = "colour"
    BOTH = "both"


@dataclass(frozen=True, kw_only=True)
class Block:
    """One term w ‖x − y‖₁^p of a distance."""

    name: str  # of the descriptor block
    weight: float  # w > 0
    power: int  # p, 1 or 2; the same for all blocks of a method

    @property
    def looks_at(self) -> LooksAt:
        """What it tells of a shape."""
        return _LOOKS_AT[self.name]


@dataclass(frozen=True, kw_only=True)
class Method:
    """A distance d(x, y) = Σ_b w_b ‖x_b − y_b‖₁^p."""

    name: str  # stable; users ask for it
    blocks: tuple[Block, ...]  # the terms
    description: str  # for people
    refined: int = 0  # how many of the first are compared again by registration of their landmarks

    @property
    def power(self) -> int:
        """The power p that all blocks share."""
        return self.blocks[0].power


DEFAULT_METHOD = "fused"
MOST = 1e9  # of a user's own weight: beyond it sums lose the other blocks
_PAPER = "Kovnatsky et al. 2011"


_LOOKS_AT = {
    "log-hks": LooksAt.GEOMETRY,
    "hks-0": LooksAt.GEOMETRY,
    "diffusion-geometric": LooksAt.GEOMETRY,
    "colour-histogram": LooksAt.COLOUR,
    "colour-curves": LooksAt.COLOUR,  # at places of the surface, but geometry alone makes none differ
    "meshhog": LooksAt.COLOUR,
    "hks-0.05": LooksAt.BOTH,
    "hks-0.1": LooksAt.BOTH,
    "diffusion-joint": LooksAt.BOTH,
}


def _table(*methods: Method) -> Mapping[str, Method]:
    return {method.name: method for method in methods}


METHODS = _table(
    Method(
        name="fused",
        blocks=(
            # the divisors bring the three distances to one scale; the blocks are kept as a byte a number
            Block(name="log-hks", weight=1 / 0.587, power=1),
            Block(name="colour-histogram", weight=1 / 1.83, power=1),
            Block(name="colour-curves", weight=1 / 150.5, power=1),
        ),
        description="Geometry, colours and where on the surface they are, then registration of the first",
        refined=24,
    ),
    Method(
        name="chks",
        blocks=(
            Block(name="hks-0", weight=1.0, power=2),
            Block(name="hks-0.05", weight=0.05, power=2),
            Block(name="hks-0.1", weight=0.1, power=2),
        ),
        description=f"Colour heat kernel signatures, three weights of colour ({_PAPER})",
    ),
    Method(
        name="hks",
        blocks=(Block(name="hks-0", weight=1.0, power=1),),
        description="Heat kernel signatures: geometry alone",
    ),
    Method(
        name="diffusion",
        blocks=(Block(name="diffusion-geometric", weight=1.0, power=1),),
        description="Distribution of diffusion distances: geometry alone",
    ),
    Method(
        name="colour-diffusion",
        blocks=(Block(name="diffusion-joint", weight=1.0, power=1),),
        description=f"Distribution of joint diffusion distances over three weights of colour ({_PAPER})",
    ),
    Method(
        name="colour-histogram",
        blocks=(Block(name="colour-histogram", weight=1.0, power=1),),
        description="Lab colour histogram: colours alone, wherever they are",
    ),
    Method(
        name="meshhog",
        blocks=(Block(name="meshhog", weight=1.0, power=1),),
        description="Histograms of colour gradients around salient points (Zaharescu et al. 2009)",
    ),
)


def method(name: str) -> Method:
    """Return a method by its name; UnknownMethod where there is none."""
    found = METHODS.get(name)
    if found is None:
        raise UnknownMethod(f"no method is called {name!r}; there are {', '.join(METHODS)}")
    return found


def with_weights(base: Method, weights: Mapping[str, float]) -> Method:
    """Return a method with some of its weights replaced; blocks that are not named keep theirs.

    Raises
    ------
    BadWeights
        A block that the method does not have, a weight that is negative or not finite, or nothing but zeros.
    """
    names = [block.name for block in base.blocks]
    for name, weight in weights.items():
        if name not in names:
            raise BadWeights(f"the method {base.name!r} has no block {name!r}, only {', '.join(names)}")
        if not (math.isfinite(weight) and 0 <= weight <= MOST):
            raise BadWeights(f"the weight of {name!r} must be a number from 0 to {MOST:g}, not {weight:g}")
    blocks = tuple(replace(block, weight=weights.get(block.name, block.weight)) for block in base.blocks)
    if not any(block.weight for block in blocks):
        raise BadWeights("at least one weight must be greater than 0")
    return replace(base, blocks=blocks)
