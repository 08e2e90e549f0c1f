"""The choices that the paper leaves open: a table of alternatives for each."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum

from benchmarks.variants import (
    CURVE_BLOCKS,
    CURVES,
    DEFAULTS,
    EVEN,
    HISTOGRAM,
    HISTOGRAMS,
    HKS_BAGS,
    LOG_HKS,
    LOG_HKS_BAGS,
    bag,
    sees_colour,
)
from index.methods import METHODS, Block, Method
from index.vocabulary import Softness
from worker.parameters import Operator, Parameters

FIRST_STAGE = "`fused`, first stage"
BOTH_STAGES = "`fused`"
ETAS = (0.0, 0.05, 0.1)
REFINED = (0, 8, 24, 48)  # of the first answers, registered in the second stage

Typical = Callable[[str], float]  # variant → its mean distance between two shapes of the gallery


class Relative(StrEnum):
    """What each block's distances are divided by, for each query anew."""

    MEAN = "mean"
    MEDIAN = "median"


@dataclass(frozen=True, kw_only=True)
class Alternative:
    """One row of a table."""

    method: str  # in which it is measured, for people
    label: str  # what is chosen
    blocks: tuple[Block, ...]  # named by variants
    shipped: bool = False  # the program does it so
    refined: int = 0  # as in `Method`
    relative: Relative | None = None  # then every block counts the same

    def formula(self) -> Method:
        """Return it as a method of a name that is unique in its table."""
        name = f"{self.method}: {self.label}"
        return Method(name=name, blocks=self.blocks, description="", refined=self.refined)

    def sees_colour(self) -> bool:
        """Tell whether any block depends on colours."""
        return any(sees_colour(block.name) for block in self.blocks)


def alone(name: str) -> tuple[Block, ...]:
    """Return one block, compared by L1."""
    return (Block(name=name, weight=1.0, power=1),)


def fused(typical: Typical, replaced: Mapping[str, str] | None = None) -> tuple[Block, ...]:
    """Return the blocks of `fused`; a variant in a block's place weighs as much in a usual distance."""
    names = {**DEFAULTS, **(replaced or {})}
    return tuple(
        replace(
            block,
            name=names[block.name],
            weight=block.weight * typical(DEFAULTS[block.name]) / typical(names[block.name]),
        )
        for block in METHODS["fused"].blocks
    )


def softness(typical: Typical) -> Iterator[Alternative]:
    """Yield rules for σ of a bag."""
    for rule in Softness:
        names = {block: bag(block, rule).name for block in ("hks-0", "hks-0.05", "hks-0.1", LOG_HKS)}
        found = {
            "`hks`": alone(names["hks-0"]),
            "`chks`": tuple(replace(block, name=names[block.name]) for block in METHODS["chks"].blocks),
            "words of log-HKS": alone(names[LOG_HKS]),
            FIRST_STAGE: fused(typical, {LOG_HKS: names[LOG_HKS]}),
        }
        shipped = rule is Softness.NEAREST
        for method, blocks in found.items():
            yield Alternative(method=method, label=rule, blocks=blocks, shipped=shipped)


def words(typical: Typical) -> Iterator[Alternative]:
    """Yield numbers of words."""
    for variant in HKS_BAGS:
        yield _alone("`hks`", "hks-0", f"{variant.n_words}", variant.name)
    for variant in LOG_HKS_BAGS:
        yield from _compared("words of log-HKS", LOG_HKS, f"{variant.n_words}", variant.name, typical)


def colour_weights(_: Typical) -> Iterator[Alternative]:
    """Yield sums over η of the distances of `chks`: the paper weighs geometry by 1, the others by η."""
    shipped = tuple(replace(block, name=DEFAULTS[block.name]) for block in METHODS["chks"].blocks)
    for power, formula in ((2, "squared"), (1, "plain")):
        for etas in ((0.0,), (0.0, 0.05), (0.0, 0.1), ETAS):
            blocks = tuple(_block_of(eta, eta or 1.0, power) for eta in etas)
            label = f"{formula}, η = {', '.join(f'{eta:g}' for eta in etas)}"
            yield Alternative(method="`chks`", label=label, blocks=blocks, shipped=blocks == shipped)
        same = tuple(_block_of(eta, 1.0, power) for eta in ETAS)
        yield Alternative(method="`chks`", label=f"{formula}, all three with weight 1", blocks=same)


def histograms(typical: Typical) -> Iterator[Alternative]:
    """Yield bins and smoothing, vertices' mean colours in place of the surface's own, and bins joined."""
    for variant in HISTOGRAMS:
        smoothed = f"smoothed by {variant.smoothing:g}" if variant.smoothing else "not smoothed"
        label = f"{variant.n_bins}³ bins, {smoothed}" + ", cell averages" * variant.cells
        if variant.chroma:
            label += ", joined evenly" if variant.chroma == EVEN else ", joined, finest around grey"
        yield from _compared("`colour-histogram`", HISTOGRAM, label, variant.name, typical)


def curves(typical: Typical) -> Iterator[Alternative]:
    """Yield bins of the colour curves, whitened and not."""
    for variant in CURVE_BLOCKS:
        label = f"{variant.n_bins} bins, {'whitened' if variant.whitened else 'raw Lab'}"
        yield from _compared("colour curves", CURVES, label, variant.name, typical)


def block_weights(typical: Typical) -> Iterator[Alternative]:
    """Yield weights of the blocks of `fused`."""
    table = fused(typical)
    total = sum(block.weight * typical(block.name) for block in table)
    equal = tuple(replace(block, weight=total / len(table) / typical(block.name)) for block in table)
    found = {"the table's": table, "equal parts of a usual distance": equal}
    for block in table:
        for factor, label in ((0.5, "half"), (2.0, "twice")):
            changed = replace(block, weight=factor * block.weight)
            found[f"{label} the {_plain(block)}"] = tuple(changed if b == block else b for b in table)
    for method, refined in ((FIRST_STAGE, 0), (BOTH_STAGES, METHODS["fused"].refined)):
        for label, blocks in found.items():
            yield Alternative(
                method=method, label=label, blocks=blocks, shipped=blocks == table, refined=refined
            )


def relative_weights(typical: Typical) -> Iterator[Alternative]:
    """Yield fixed weights, and distances divided by what is usual for the query."""
    table = fused(typical)
    yield Alternative(method=FIRST_STAGE, label="fixed", blocks=table, shipped=True)
    for relative in Relative:
        label = f"each divided by the query's {relative}"
        yield Alternative(method=FIRST_STAGE, label=label, blocks=table, relative=relative)


def second_stage(typical: Typical) -> Iterator[Alternative]:
    """Yield how many of the first answers are registered with the query."""
    for refined in REFINED:
        label = f"the first {refined}" if refined else "none"
        shipped = refined == METHODS["fused"].refined
        yield Alternative(
            method=BOTH_STAGES, label=label, blocks=fused(typical), shipped=shipped, refined=refined
        )


def of_operator(operator: Operator) -> list[Alternative]:
    """Return the methods that heat matters to, with the table's weights, as one operator of the two."""
    found = {
        "`hks`": METHODS["hks"].blocks,
        "`chks`": METHODS["chks"].blocks,
        "words of log-HKS": alone(LOG_HKS),
        FIRST_STAGE: METHODS["fused"].blocks,
    }
    return [
        Alternative(
            method=method,
            label=operator,
            blocks=tuple(replace(block, name=DEFAULTS[block.name]) for block in blocks),
            shipped=operator is Parameters().operator,
        )
        for method, blocks in found.items()
    ]


TABLES: Mapping[str, Callable[[Typical], Iterator[Alternative]]] = {
    "softness": softness,
    "words": words,
    "colour-weights": colour_weights,
    "histogram": histograms,
    "curves": curves,
    "block-weights": block_weights,
    "relative-weights": relative_weights,
    "second-stage": second_stage,
}  # by the markers of docs/choices.md


def _alone(method: str, block: str, label: str, name: str) -> Alternative:
    return Alternative(method=method, label=label, blocks=alone(name), shipped=name == DEFAULTS[block])


def _compared(method: str, block: str, label: str, name: str, typical: Typical) -> Iterator[Alternative]:
    """Yield a variant of a block of `fused` alone, and in its place."""
    yield _alone(method, block, label, name)
    blocks = fused(typical, {block: name})
    yield Alternative(method=FIRST_STAGE, label=label, blocks=blocks, shipped=name == DEFAULTS[block])


def _block_of(eta: float, weight: float, power: int) -> Block:
    return Block(name=DEFAULTS[f"hks-{eta:g}"], weight=weight, power=power)


def _plain(block: Block) -> str:
    return block.name.split(":")[0]
