"""The vocabulary of a library: words, softness and distance grids, learnt from its own shapes."""

import hashlib
import io
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from importlib import resources
from zipfile import BadZipFile

import numpy as np
import numpy.typing as npt
from scipy.cluster.vq import ClusterError, kmeans2
from scipy.spatial.distance import cdist

from index.errors import BadVocabulary

SingleArray = npt.NDArray[np.float32]
FloatArray = npt.NDArray[np.float64]

N_WORDS = {"log-hks": 128}  # of each block; 48, the paper's number, for the others
PAPER_WORDS = 48
FEATURES = ("meshhog",)  # blocks whose rows are features of their own, not vertices; a shape may have none
GRIDS = ("diffusion-geometric", "diffusion-joint")
GRID_POINTS = 128
SHORTEST = 0.005  # quantile of all distances at which a grid begins
PER_GRID = 128  # quantiles of a shape's distances that a grid is made from
STANDARDISED = ("log-hks",)  # blocks whose dimensions have no common unit
PER_SHAPE = 400  # signatures drawn from a shape, in proportion to area
MOST = 100_000  # signatures in all: of a large library each shape gives fewer
STARTS = 3  # of k-means; the best is kept
ROUNDS = 60  # of k-means


class Softness(StrEnum):
    """How σ of the soft assignment follows from the words."""

    NEAREST = "nearest"  # median distance to the nearest other word; the default
    PAPER = "paper"  # twice the median of all distances between words, read as σ
    HARD = "hard"  # 0: each point belongs to its nearest word


@dataclass(frozen=True, kw_only=True, eq=False)
class Words:
    """The words of one block."""

    words: FloatArray  # (v, d), in standardised units
    centre: FloatArray  # (d,), subtracted from a signature
    spread: FloatArray  # (d,), then divided by
    softness: float  # σ, in standardised units


@dataclass(frozen=True, kw_only=True, eq=False)
class Vocabulary:
    """What turns signatures into comparable blocks."""

    fingerprint: str  # of the parameters whose signatures it was learnt from
    words: Mapping[str, Words]  # by block
    grids: Mapping[str, FloatArray]  # (g,) distances at which a distribution is read, by block

    @cached_property
    def id(self) -> str:
        """A name that follows from the content."""
        return "v-" + hashlib.sha256(self.to_bytes()).hexdigest()[:16]

    def to_bytes(self) -> bytes:
        """Write the vocabulary; the same vocabulary gives the same bytes."""
        arrays: dict[str, npt.NDArray[np.generic]] = {"fingerprint": np.array(self.fingerprint)}
        for block, words in sorted(self.words.items()):
            for part in ("words", "centre", "spread"):
                arrays[f"{block}/{part}"] = getattr(words, part)
            arrays[f"{block}/softness"] = np.array(words.softness)
        arrays |= {f"{block}/grid": grid for block, grid in sorted(self.grids.items())}
        buffer = io.BytesIO()
        np.savez(buffer, allow_pickle=False, **arrays)  # numpy dates every entry 1980
        return buffer.getvalue()

    @classmethod
    def from_bytes(cls, data: bytes) -> "Vocabulary":
        """Read what `to_bytes` wrote.

        Raises
        ------
        BadVocabulary
            Where the bytes are something else.
        """
        try:
            with np.load(io.BytesIO(data), allow_pickle=False) as arrays:
                return cls._from_arrays(dict(arrays))
        except (ValueError, KeyError, OSError, EOFError, BadZipFile) as error:
            raise BadVocabulary(
                "A vocabulary written by Faience was expected; this file is not one."
            ) from error

    @classmethod
    def _from_arrays(cls, arrays: Mapping[str, npt.NDArray[np.generic]]) -> "Vocabulary":
        blocks = sorted(name.removesuffix("/words") for name in arrays if name.endswith("/words"))
        numbers = {
            name: np.asarray(array, np.float64) for name, array in arrays.items() if name != "fingerprint"
        }
        words = {
            block: Words(
                words=numbers[f"{block}/words"],
                centre=numbers[f"{block}/centre"],
                spread=numbers[f"{block}/spread"],
                softness=float(numbers[f"{block}/softness"]),
            )
            for block in blocks
        }
        grids = {name.removesuffix("/grid"): grid for name, grid in numbers.items() if name.endswith("/grid")}
        return cls(fingerprint=str(arrays["fingerprint"]), words=words, grids=grids)


def default_vocabulary() -> Vocabulary:
    """Read the vocabulary that ships with the project; `make vocabulary` learns it again."""
    return Vocabulary.from_bytes(resources.files("index").joinpath("default-vocabulary.npz").read_bytes())


def learn_vocabulary(
    shapes: Iterable[Mapping[str, SingleArray]],
    fingerprint: str,
    softness: Softness = Softness.NEAREST,
    seed: int = 0,
) -> Vocabulary:
    """Learn words by k-means, and grids from the range of distances.

    Parameters
    ----------
    shapes : iterable of signatures
        Of each shape: ``areas`` (n,), (n, d) arrays whose names are blocks of words, and (q,) quantiles
        of distances.
    fingerprint : str
        Of the parameters that the signatures were computed with.
    softness : Softness
        The rule for σ.
    seed : int
        Of the draws.

    Returns
    -------
    Vocabulary

    Raises
    ------
    BadVocabulary
        Where the shapes show fewer different signatures than there are words.
    """
    samples, distances = _gather(shapes, np.random.default_rng(seed))
    words = {
        block: learn_words(parts, block, softness, seed)
        for block, parts in samples.items()
        if block not in FEATURES or len(np.unique(parts, axis=0)) >= PAPER_WORDS  # a library without colours
    }
    grids = {block: _grid(pooled) for block, pooled in distances.items()}
    return Vocabulary(fingerprint=fingerprint, words=words, grids=grids)


def learn_words(samples: FloatArray, block: str, softness: Softness, seed: int) -> Words:
    """Cluster the signatures (s, d) of one block into its words."""
    centre, spread = np.zeros(samples.shape[1]), np.ones(samples.shape[1])
    if block in STANDARDISED:
        centre, spread = samples.mean(axis=0), np.maximum(samples.std(axis=0), np.finfo(float).tiny)
    words = _cluster((samples - centre) / spread, N_WORDS.get(block, PAPER_WORDS), seed)
    return Words(words=words, centre=centre, spread=spread, softness=softness_of(words, softness))


def softness_of(words: FloatArray, rule: Softness) -> float:
    """Return σ for words (v, d) by a rule; in the units of the words."""
    distances = cdist(words, words)
    if rule is Softness.HARD:
        return 0.0
    if rule is Softness.PAPER:
        return 2.0 * float(np.median(distances[np.triu_indices(len(words), 1)]))
    np.fill_diagonal(distances, np.inf)
    return float(np.median(distances.min(axis=1)))


def _gather(
    shapes: Iterable[Mapping[str, SingleArray]], random: np.random.Generator
) -> tuple[dict[str, FloatArray], dict[str, FloatArray]]:
    """Draw signatures of every block by area, and quantiles of distances evenly."""
    draws: dict[str, list[FloatArray]] = {}
    distances: dict[str, list[FloatArray]] = {}
    per_shape = PER_SHAPE
    for n_shapes, signatures in enumerate(shapes, 1):
        areas = np.asarray(signatures["areas"], np.float64)
        rows = random.choice(len(areas), per_shape, p=areas / areas.sum())
        for block in _word_blocks(signatures):
            drawn = _evenly(len(signatures[block]), per_shape) if block in FEATURES else rows
            draws.setdefault(block, []).append(np.asarray(signatures[block][drawn], np.float64))
        for block in GRIDS:
            quantiles = np.asarray(signatures[block], np.float64)
            distances.setdefault(block, []).append(quantiles[:: max(1, len(quantiles) // PER_GRID)])
        if n_shapes * per_shape > MOST and per_shape > 1:
            per_shape //= 2
            draws = {block: [part[:per_shape] for part in parts] for block, parts in draws.items()}
    if not draws:
        raise BadVocabulary("A vocabulary is learnt from shapes; there is none that is ready.")
    pooled = {block: np.concatenate(parts) for block, parts in distances.items()}
    return {block: np.vstack(parts) for block, parts in draws.items()}, pooled


def _grid(distances: FloatArray) -> FloatArray:
    """Spread a grid over the distances of all shapes, in equal ratios: joint ones span many orders of ten."""
    longest = max(float(distances.max()), float(np.finfo(np.float32).tiny))
    shortest = max(float(np.quantile(distances, SHORTEST)), 1e-9 * longest)
    return np.exp(np.linspace(np.log(shortest), np.log(longest), GRID_POINTS))


def _word_blocks(signatures: Mapping[str, SingleArray]) -> Iterator[str]:
    return (name for name in sorted(signatures) if name in ("log-hks", *FEATURES) or name.startswith("hks-"))


def _evenly(n_rows: int, most: int) -> npt.NDArray[np.int64]:
    """Choose rows of features that are not vertices, each as good as another."""
    return np.unique(np.linspace(0, n_rows - 1, min(n_rows, most)).astype(np.int64))


def _cluster(samples: FloatArray, n_words: int, seed: int) -> FloatArray:
    """Run k-means from several starts; (v, d), the words of the best, in lexical order."""
    if len(np.unique(samples, axis=0)) < n_words:
        raise BadVocabulary(
            f"{n_words} different words were expected, but the shapes show too few. Index more shapes first."
        )
    scale = float(samples.std())  # k-means++ draws by squared distances, which must not underflow
    runs = [
        run
        for start in range(STARTS)
        if (run := _k_means(samples / scale, n_words, seed + start)) is not None
    ]
    if not runs:
        raise BadVocabulary(
            f"The shapes' signatures could not be grouped into {n_words} words. Index more shapes first."
        )
    words = min(runs, key=lambda run: run[0])[1] * scale
    return words[np.lexsort(words.T[::-1])]


def _k_means(samples: FloatArray, n_words: int, seed: int) -> tuple[float, FloatArray] | None:
    """Cluster once; mean squared distance and words, or None where a word lost all its samples."""
    try:
        words, labels = kmeans2(samples, n_words, iter=ROUNDS, minit="++", missing="raise", rng=seed)
    except ClusterError:
        return None
    return float(np.mean((samples - words[labels]) ** 2)), words
