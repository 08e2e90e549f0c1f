"""The claims of the evaluation, on real meshes: strength 4 of the rows that are hardest or tell most."""

from dataclasses import replace
from pathlib import Path

import pytest

from index.methods import METHODS
from index.vocabulary import default_vocabulary
from service.evaluation.describing import Setting, describe_all
from service.evaluation.folder import read_folder
from service.evaluation.measuring import load, measure
from service.evaluation.protocol import ISOMETRY, MIXED, PARTIALITY
from service.evaluation.scores import Scores, score
from service.evaluation.suites import Suite, suites
from service.jobs.executors import child_limits
from service.jobs.pool import ProcessPerJob
from service.settings import Settings
from worker.parameters import Parameters

STRENGTH = 4
ROWS = (ISOMETRY, PARTIALITY, "brightness-", "hue", "noise", MIXED)
WHOLE_ROWS = ("brightness-", "hue", "noise")  # the triangles stay as they are


@pytest.fixture(scope="module")
def scores(data_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Scores]:
    suite = _some(suites(read_folder(data_folder), twins=False, hard=False)[0])
    setting = Setting(
        folder=data_folder,
        cache=tmp_path_factory.mktemp("cache"),
        parameters=Parameters(),
        vocabulary=default_vocabulary(),
    )
    pool = ProcessPerJob(slots=2, limits=child_limits(Settings()))
    try:
        sum(describe_all(pool, setting, suite.recipes()))
        loaded = load(suite, setting.open_cache())
        assert len(loaded.shapes) == len(suite.gallery)  # every mesh is accepted
        assert all(described.refused is None for described in loaded.queries)
        return score(measure(pool, loaded, list(METHODS.values()), {}))
    finally:
        pool.shutdown(cancel_futures=True)


def _some(suite: Suite) -> Suite:
    queries = (query for query in suite.queries if query.strength == STRENGTH)
    return replace(suite, queries=tuple(query for query in queries if query.transformation in ROWS))


def precision(scores: dict[str, Scores], method: str, row: str) -> float:
    found = scores[method].mean_precision[row][-1]
    assert found is not None
    return found


def test_fused_finds_almost_everything_under_every_change(scores: dict[str, Scores]) -> None:
    assert min(precision(scores, "fused", row) for row in ROWS) >= 95
    assert sum(precision(scores, "fused", row) for row in ROWS) / len(ROWS) >= 98


def test_geometry_does_not_see_light_and_colours_do_not_see_pose(scores: dict[str, Scores]) -> None:
    for row in WHOLE_ROWS:
        assert precision(scores, "hks", row) == pytest.approx(100)
        assert precision(scores, "diffusion", row) == pytest.approx(100)
    assert precision(scores, "colour-histogram", ISOMETRY) >= 99
    assert precision(scores, "colour-histogram", "brightness-") < 60


def test_no_method_of_the_paper_finds_as_much_as_fused(scores: dict[str, Scores]) -> None:
    overall = {method: sum(precision(scores, method, row) for row in ROWS) / len(ROWS) for method in scores}
    fused = overall.pop("fused")
    assert fused > max(overall.values()) + 5
