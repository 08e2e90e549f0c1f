"""Alternatives are compared fairly: same meshes, same draws, weights that follow the size of distances."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchmarks.alternatives import TABLES, Alternative, Relative, alone, fused, of_operator
from benchmarks.choices import OPERATOR, PAGE, prepare, suites_of
from benchmarks.comparing import (
    PAPER,
    TWIN_COLUMN,
    TWINS,
    block_distances,
    relative_distances,
    rows_of,
    table_of,
    typical_of,
)
from benchmarks.pages import places_of
from benchmarks.variant_signatures import Bench, histogram_of
from benchmarks.variant_words import cluster
from benchmarks.variants import BAGS, CURVE_BLOCKS, DEFAULTS, HISTOGRAMS, Histogram
from index.methods import METHODS, Block
from index.vocabulary import Softness, learn_words
from service.evaluation.cache import Described
from service.evaluation.folder import read_folder
from service.evaluation.measuring import Loaded
from service.evaluation.protocol import ISOMETRY, MIXED, PARTIALITY, Geometry, Query, Recipe
from service.evaluation.suites import Entry, Suite
from service.refining import LANDMARKS, QUERY_LADDER
from tests.evaluations import COARSE, InThisProcess, make_folder
from worker.canonical import Surface
from worker.descriptors.histograms import lab_histogram
from worker.parameters import Operator

NAMES = {
    *(variant.name for variant in BAGS),
    *(variant.name for variant in HISTOGRAMS),
    *(variant.name for variant in CURVE_BLOCKS),
}
MODELS = ("cat", "dog", "owl", "eel")
ASKED = (ISOMETRY, PARTIALITY, "noise", MIXED)
REFUSED = Described(blocks={}, refused="no faces")
GEOMETRY, COLOUR = DEFAULTS["hks-0"], DEFAULTS["colour-histogram"]


def loaded(test: str = PAPER) -> Loaded:
    """Return a test where colours tell the model and geometry tells nothing."""
    places = np.eye(len(MODELS), dtype=np.float32)
    shapes = tuple(Described(blocks={GEOMETRY: np.ones(2, np.float32), COLOUR: row}) for row in places)
    recipes = {name: Recipe(geometry=Geometry(model=name, source=name)) for name in MODELS}
    queries = tuple(
        Query(model=name, transformation=row, strength=1, recipe=recipes[name])
        for row in ASKED
        for name in MODELS
    )
    entries = tuple(Entry(name=name, recipe=recipe) for name, recipe in recipes.items())
    suite = Suite(test=test, title=test, explanation="", queries=queries, gallery=entries)
    return Loaded(suite=suite, entries=entries, shapes=shapes, queries=shapes * len(ASKED))


def of_one(name: str) -> Alternative:
    return Alternative(method="m", label=name, blocks=alone(name))


@pytest.mark.parametrize("table", TABLES)
def test_a_table_compares_known_variants_under_different_names(table: str) -> None:
    alternatives = list(TABLES[table](lambda _: 1.0))
    assert len({alternative.formula().name for alternative in alternatives}) == len(alternatives)
    assert {block.name for alternative in alternatives for block in alternative.blocks} <= NAMES


@pytest.mark.parametrize("table", TABLES)
def test_what_the_program_does_is_marked_once_for_each_method(table: str) -> None:
    alternatives = list(TABLES[table](lambda _: 1.0))
    shipped = [alternative.method for alternative in alternatives if alternative.shipped]
    assert sorted(shipped) == sorted({alternative.method for alternative in alternatives})


def test_the_operator_that_the_program_uses_is_marked() -> None:
    marked = [alternative.shipped for operator in Operator for alternative in of_operator(operator)]
    assert marked == [True] * 4 + [False] * 4


def test_shipped_variants_have_the_weights_of_the_table() -> None:
    weights = [block.weight for block in fused(lambda name: float(len(name)))]
    assert weights == [block.weight for block in METHODS["fused"].blocks]


def test_a_variant_counts_as_much_as_the_block_whose_place_it_takes() -> None:
    usual = {**dict.fromkeys(DEFAULTS.values(), 3.0), "other": 12.0}
    replaced = fused(usual.__getitem__, {"colour-curves": "other"})
    parts = [block.weight * usual[block.name] for block in replaced]
    assert parts == pytest.approx([block.weight * 3.0 for block in METHODS["fused"].blocks])


def test_equal_parts_are_equal_and_leave_the_usual_distance() -> None:
    usual = {name: float(k + 1) for k, name in enumerate(DEFAULTS.values())}
    table, equal = [
        [block.weight * usual[block.name] for block in alternative.blocks]
        for alternative in list(TABLES["block-weights"](usual.__getitem__))[:2]
    ]
    assert equal == pytest.approx([np.mean(table)] * len(table))


def test_the_usual_distance_leaves_out_that_of_a_shape_to_itself() -> None:
    assert typical_of(loaded().shapes)(COLOUR) == pytest.approx(2.0)


def test_relative_distances_average_one_for_every_block() -> None:
    random = np.random.default_rng(3)
    shapes = [
        Described(blocks={"a": random.random(4, np.float32), "b": 1e6 * random.random(9, np.float32)})
        for _ in MODELS
    ]
    queries = (REFUSED, *shapes)
    test = replace(loaded(), queries=queries, shapes=tuple(shapes))
    blocks = tuple(Block(name=name, weight=1.0, power=1) for name in "ab")
    alternative = Alternative(method="m", label="l", blocks=blocks, relative=Relative.MEAN)
    distances = relative_distances(alternative, test)
    assert np.isinf(distances[0]).all()
    assert distances[1:].mean(axis=1) == pytest.approx(2.0)
    one = replace(alternative, blocks=blocks[1:], relative=Relative.MEDIAN)
    plain = block_distances("b", test.queries, test.shapes)[1:]
    assert relative_distances(one, test)[1:] == pytest.approx(plain / np.median(plain, axis=1, keepdims=True))


def test_rows_tell_what_sees_the_right_answer_and_leave_out_twins_where_colours_do_not_count() -> None:
    tests = {PAPER: loaded(), TWINS: loaded(TWINS)}
    geometry, colour = rows_of(InThisProcess(), tests, [of_one(GEOMETRY), of_one(COLOUR)], {})
    assert [colour[column] for column in ("all", *ASKED, TWIN_COLUMN)] == ["100.0"] * 6
    assert [geometry[column] for column in ("all", *ASKED, TWIN_COLUMN)] == ["25.0"] * 5 + [""]


def test_rows_of_one_method_stand_together_and_may_have_a_cost() -> None:
    tests = {PAPER: loaded()}
    first, other = of_one(GEOMETRY), replace(of_one(GEOMETRY), method="n")
    cost = ("price", lambda alternative, _: alternative.label.upper())
    rows = list(rows_of(InThisProcess(), tests, [first, other, of_one(COLOUR)], {}, cost))
    assert [row["method"] for row in rows] == ["m", "m", "n"]
    assert rows[1]["price"] == COLOUR.upper()


def test_a_table_is_markdown() -> None:
    table = table_of([{"method": "`m`", "": "**x**", "all": "1.0"}, {"method": "`m`", "": "y", "all": "2.0"}])
    assert table == "| method |  | all |\n| --- | --- | --: |\n| `m` | **x** | 1.0 |\n| `m` | y | 2.0 |\n"


def test_the_page_has_a_place_for_every_table() -> None:
    assert places_of(PAGE.read_text(encoding="utf-8")) == ["measured", *TABLES, OPERATOR]


def test_words_are_those_that_a_library_would_learn() -> None:
    samples = np.random.default_rng(5).random((600, 6)) * [1, 2, 3, 4, 5, 6]
    learnt = learn_words(samples, "log-hks", Softness.HARD, 0)
    again = cluster(samples, "log-hks", len(learnt.words))
    for part in ("words", "centre", "spread", "softness"):
        assert np.array_equal(getattr(again, part), getattr(learnt, part))


def test_cell_averages_count_by_area() -> None:
    colours = np.array([[30.0, 40.0, 10.0], [70.0, -30.0, 20.0]])
    surface = Surface(
        vertices=np.zeros((2, 3)),
        faces=np.zeros((0, 3), np.int64),
        srgb=np.zeros((2, 3)),
        lab=colours,
        sample_lab=np.zeros((400, 3)),
    )
    found = histogram_of(Histogram(cells=True), surface, np.array([3.0, 1.0]))
    expected = lab_histogram(colours[[0, 0, 0, 1]], Histogram().n_bins, Histogram().smoothing)
    assert found == pytest.approx(expected)


def test_only_chosen_strengths_are_asked(tmp_path: Path) -> None:
    tests = suites_of(read_folder(make_folder(tmp_path)), (1, 5))
    assert {query.strength for query in tests[PAPER].queries} == {1, 5}
    assert {query.strength for query in tests[OPERATOR].queries} == {3}
    assert len(tests[TWINS].gallery) > len(tests[PAPER].gallery) == len(tests[OPERATOR].gallery)


def test_every_variant_is_made_of_every_mesh_and_kept(tmp_path: Path) -> None:
    bench = Bench(folder=make_folder(tmp_path / "data"), cache=tmp_path / "cache", parameters=COARSE)
    test = suites_of(read_folder(bench.folder), (1,))[PAPER]
    few = {PAPER: replace(test, queries=test.queries[:1])}
    made = prepare(InThisProcess(), bench, few)[PAPER]
    for described in (*made.queries, *made.shapes):
        assert {*NAMES, LANDMARKS, QUERY_LADDER} <= set(described.blocks)
        sums = [described.blocks[bag.name].sum() for bag in BAGS]
        assert sums == pytest.approx([1.0] * len(BAGS), rel=1e-4)
        assert [len(described.blocks[bag.name]) for bag in BAGS] == [bag.n_words for bag in BAGS]
    files = {path: path.stat().st_mtime_ns for path in bench.cache.rglob("*.npz")}
    prepare(InThisProcess(), bench, few)
    assert {path: path.stat().st_mtime_ns for path in bench.cache.rglob("*.npz")} == files
