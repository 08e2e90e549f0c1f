"""Words of many kinds and numbers, learnt from one gallery, and the bags that they make."""

from collections.abc import Iterable, Mapping
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np

from benchmarks.variant_signatures import Bench, share_out
from benchmarks.variants import BAGS, COLOURED, SHAPE, Bag
from index.vocabulary import (
    PER_SHAPE,
    STANDARDISED,
    Vocabulary,
    Words,
    _cluster,  # learn_words knows one number of words for each block
    softness_of,
)
from service.evaluation.cache import Cache, Described
from service.evaluation.protocol import Geometry, Recipe
from service.quantisation import quantise
from service.refining import QUERY_LADDER
from worker.arrays import FloatArray, SingleArray

SEED = 0  # of the draws and of k-means


def make_blocks(pool: Executor, bench: Bench, recipes: Iterable[Recipe], vocabulary: Vocabulary) -> Cache:
    """Make everything that is compared, of meshes that are described; return where it is kept."""
    blocks = bench.open("blocks", vocabulary.id)
    todo = [recipe for recipe in recipes if recipe not in blocks]
    share_out(pool, "Making bags", todo, quantise_group, bench, vocabulary)
    return blocks


def learn(pool: Executor, bench: Bench, gallery: Iterable[Recipe]) -> Vocabulary:
    """Learn the words of every bag from the same draws of a gallery's signatures."""
    samples = draw(bench, gallery)
    tasks = list(dict.fromkeys((bag.signature, bag.n_words) for bag in BAGS))
    clustered = pool.map(cluster, [samples[signature] for signature, _ in tasks], *zip(*tasks, strict=True))
    words = dict(zip(tasks, clustered, strict=True))
    return Vocabulary(
        fingerprint=bench.parameters.fingerprint(),
        words={bag.name: _softened(words[bag.signature, bag.n_words], bag) for bag in BAGS},
        grids={},
    )


def draw(bench: Bench, gallery: Iterable[Recipe]) -> dict[str, FloatArray]:
    """Draw signatures of every kind by area, the same points of each; (s, 6) by name."""
    random, parts = np.random.default_rng(SEED), dict[str, list[SingleArray]]()
    for recipe in gallery:
        described = bench.colours().load(recipe)
        if described.refused is None:
            found = {**bench.triangles(recipe.geometry), **described.blocks}
            areas = found["areas"].astype(np.float64)
            rows = random.choice(len(areas), PER_SHAPE, p=areas / areas.sum())
            for signature in SHAPE + COLOURED:
                parts.setdefault(signature, []).append(found[signature][rows])
    return {signature: np.vstack(drawn).astype(np.float64) for signature, drawn in parts.items()}


def cluster(samples: FloatArray, signature: str, n_words: int) -> Words:
    """Cluster signatures (s, d) as `index.vocabulary.learn_words` does, into any number of words; hard."""
    centre, spread = np.zeros(samples.shape[1]), np.ones(samples.shape[1])
    if signature in STANDARDISED:
        centre, spread = samples.mean(axis=0), samples.std(axis=0)
    words = _cluster((samples - centre) / spread, n_words, SEED)
    return Words(words=words, centre=centre, spread=spread, softness=0.0)


def quantise_group(
    bench: Bench, vocabulary: Vocabulary, geometry: Geometry, recipes: tuple[Recipe, ...]
) -> None:
    """Make the blocks of meshes that differ in colour alone, into their cache."""
    colours, blocks = bench.colours(), bench.open("blocks", vocabulary.id)
    shared: dict[str, SingleArray] = {}
    for recipe in recipes:
        described = colours.load(recipe)
        if described.refused is None:
            triangles = bench.triangles(geometry)
            shared = shared or {
                QUERY_LADDER: triangles[QUERY_LADDER],
                **_bags(triangles, triangles["areas"], vocabulary),
            }
            own = {name: block for name, block in described.blocks.items() if name not in COLOURED}
            bags = _bags(described.blocks, triangles["areas"], vocabulary)
            described = Described(blocks={**shared, **own, **bags})
        blocks.store(recipe, described)


def _softened(words: Words, bag: Bag) -> Words:
    return replace(words, softness=softness_of(words.words, bag.softness))


def _bags(
    signatures: Mapping[str, SingleArray], areas: SingleArray, vocabulary: Vocabulary
) -> dict[str, SingleArray]:
    """Make every bag of those signatures that are there."""
    named = {bag.name: signatures[bag.signature] for bag in BAGS if bag.signature in signatures}
    words = {name: vocabulary.words[name] for name in named}
    return quantise({"areas": areas, **named}, replace(vocabulary, words=words))
