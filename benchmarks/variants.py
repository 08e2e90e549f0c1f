"""Variants of the descriptors: bags of other words, other histograms, other curves."""

from collections.abc import Mapping
from dataclasses import dataclass

from index.vocabulary import N_WORDS, PAPER_WORDS, Softness
from worker.parameters import Parameters

SHAPE = ("hks-0", "log-hks")  # signatures that colours do not change
COLOURED = ("hks-0.05", "hks-0.1")  # those that they do
LOG_HKS, HISTOGRAM, CURVES = "log-hks", "colour-histogram", "colour-curves"  # blocks of `fused`
SHIPPED = Parameters()
EVEN = (2,) * 8  # bins that are joined, the same for all colours


@dataclass(frozen=True, kw_only=True)
class Bag:
    """A block of words."""

    signature: str  # one of SHAPE or COLOURED
    n_words: int
    softness: Softness = Softness.NEAREST

    @property
    def name(self) -> str:
        """Of the block."""
        return f"{self.signature}: {self.n_words} words, {self.softness}"


@dataclass(frozen=True, kw_only=True)
class Histogram:
    """A Lab histogram."""

    n_bins: int = SHIPPED.histogram_bins  # along each axis
    smoothing: float = SHIPPED.histogram_smoothing  # σ in bins
    cells: bool = False  # of the vertices' mean colours, not of the surface's own
    chroma: tuple[int, ...] = ()  # bins that are joined along a and b after smoothing, where any are

    @property
    def name(self) -> str:
        """Of the block."""
        source = "means" if self.cells else "samples"
        joined = f", joined by {'-'.join(map(str, self.chroma))}" * bool(self.chroma)
        return f"{HISTOGRAM}: {self.n_bins} bins, smoothed {self.smoothing:g}, {source}{joined}"


@dataclass(frozen=True, kw_only=True)
class Curves:
    """Colour curves."""

    n_bins: int = SHIPPED.curve_bins
    whitened: bool = True

    @property
    def name(self) -> str:
        """Of the block."""
        return f"{CURVES}: {self.n_bins} bins, {'whitened' if self.whitened else 'raw'}"


def bag(signature: str, softness: Softness = Softness.NEAREST) -> Bag:
    """Return a bag of as many words as the program learns."""
    return Bag(signature=signature, n_words=N_WORDS.get(signature, PAPER_WORDS), softness=softness)


HKS_BAGS = tuple(Bag(signature="hks-0", n_words=count) for count in (24, 48, 96))
LOG_HKS_BAGS = tuple(Bag(signature=LOG_HKS, n_words=count) for count in (48, 64, 128, 256))
SOFT_BAGS = tuple(bag(signature, rule) for rule in Softness for signature in SHAPE + COLOURED)
BAGS = tuple(dict.fromkeys((*SOFT_BAGS, *HKS_BAGS, *LOG_HKS_BAGS)))
HISTOGRAMS = (
    *(Histogram(n_bins=count, smoothing=smoothing) for count in (8, 12, 16) for smoothing in (0.0, 0.7, 1.2)),
    Histogram(cells=True),
    Histogram(chroma=EVEN),
    Histogram(chroma=SHIPPED.histogram_chroma),
)
CURVE_BLOCKS = tuple(Curves(n_bins=count, whitened=white) for white in (True, False) for count in (8, 16, 32))
DEFAULTS: Mapping[str, str] = {
    **{signature: bag(signature).name for signature in SHAPE + COLOURED},
    HISTOGRAM: Histogram(chroma=SHIPPED.histogram_chroma).name,
    CURVES: Curves().name,
}  # block of a method → the variant that the program ships


def sees_colour(name: str) -> bool:
    """Tell whether a variant depends on colours."""
    return name.split(":")[0] not in SHAPE
