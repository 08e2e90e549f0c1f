"""`faience evaluate`: a folder is measured once, told three ways, and from the cache afterwards."""

import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from typer.testing import Result

from index.methods import METHODS
from service.commands import evaluating
from service.evaluation.ablation import ablations
from service.evaluation.photometric import PHOTOMETRIC
from service.evaluation.protocol import ISOMETRY, MIXED, TRANSFORMATIONS
from tests.commanding import plain_line, run
from tests.evaluations import COARSE, coarse_vocabulary, make_folder

Evaluated = tuple[Path, Path, Result]  # folder, output, what was said


@pytest.fixture(scope="module", autouse=True)
def _coarse() -> Iterator[None]:
    """Describe at a resolution that takes a twentieth of the time, with words for it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(evaluating, "Parameters", lambda: COARSE)
        patch.setattr(evaluating, "default_vocabulary", coarse_vocabulary)
        yield


@pytest.fixture(scope="module")
def evaluated(tmp_path_factory: pytest.TempPathFactory) -> Evaluated:
    """Evaluate two models by all methods: 110 queries."""
    path = tmp_path_factory.mktemp("evaluation")
    folder, out = make_folder(path / "folder"), path / "out"
    return folder, out, run("evaluate", folder, "--out", out)


def results(out: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((out / "results.json").read_text(encoding="utf-8"))
    return found


def cached(out: Path) -> dict[str, int]:
    return {file.name: file.stat().st_mtime_ns for file in (out / "cache").iterdir()}


def own(evaluated: Evaluated, path: Path) -> tuple[Path, Path]:
    """Return copies of the folder and of what was described, to change."""
    folder, out, _ = evaluated
    shutil.copytree(folder, path / "folder")
    return path / "folder", shutil.copytree(out, path / "out")


def test_every_method_is_measured_on_every_row(evaluated: Evaluated) -> None:
    _, out, result = evaluated
    assert result.exit_code == 0
    (paper,) = results(out)["tests"]
    assert (paper["test"], paper["questions"], paper["gallery"]) == ("paper", 110, 3)
    assert list(paper["methods"]) == list(METHODS)
    for method in paper["methods"].values():
        assert list(method["map"]) == ["all", *TRANSFORMATIONS]
        assert all(100 / 3 <= value <= 100 for row in method["map"].values() for value in row)


def test_geometry_alone_finds_every_shape_under_another_light(evaluated: Evaluated) -> None:
    (paper,) = results(evaluated[1])["tests"]
    for name in ("hks", "diffusion"):  # light leaves them at distance 0
        rows = paper["methods"][name]["map"]
        assert {value for row in PHOTOMETRIC for value in rows[row]} == {100.0}


def test_results_tell_what_they_follow_from(evaluated: Evaluated) -> None:
    assert results(evaluated[1])["settings"] == {
        "folder": "folder",
        "descriptors": COARSE.fingerprint(),
        "vocabulary": coarse_vocabulary().id,
    }


def test_tables_pages_and_the_time_are_told(evaluated: Evaluated) -> None:
    _, out, result = evaluated
    for word in ("The paper's protocol", "isometry+topology", "saturation-", "fused", "meshhog"):
        assert word in result.stdout
    assert "113/113" in result.stderr
    assert f"{out / 'report.html'}".replace("\n", "") in result.stderr.replace("\n", "")
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "110 queries were made from 2 coloured models" in page
    assert page.count("data:image/webp;base64,") >= 3


def test_another_run_describes_nothing_and_finds_the_same(
    evaluated: Evaluated, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder, out = own(evaluated, tmp_path)
    before = cached(out)
    monkeypatch.setattr("service.evaluation.describing.describe_group", None)  # would be called to describe
    result = run("evaluate", folder, "--out", out, "--method", "chks", "--method", "hks", "--json")
    assert result.exit_code == 0
    assert cached(out) == before
    found = json.loads(result.stdout)
    assert found == results(out)
    methods = results(evaluated[1])["tests"][0]["methods"]
    assert found["tests"][0]["methods"] == {name: methods[name] for name in ("chks", "hks")}


def test_a_changed_mesh_is_described_anew_and_nothing_else(evaluated: Evaluated, tmp_path: Path) -> None:
    folder, out = own(evaluated, tmp_path)
    before = cached(out)
    shutil.copy(folder / "posed/bird/pose_01.ply", folder / "clutter/lizard.ply")
    assert run("evaluate", folder, "--out", out, "--method", "hks").exit_code == 0
    after = cached(out)
    assert before.items() <= after.items()
    assert len(after) == len(before) + 1


def test_options_add_tests_and_parts(evaluated: Evaluated, tmp_path: Path) -> None:
    folder, out = own(evaluated, tmp_path)
    result = run("evaluate", folder, "--out", out, "--twins", "--ablation", "--method", "hks", "--workers", 1)
    assert result.exit_code == 0
    found = results(out)["tests"]
    sizes = [("paper", 110, 3), ("twins", 110, 3 + 4), ("combined", 20, 3)]
    assert [(test["test"], test["questions"], test["gallery"]) for test in found] == sizes
    names = ["hks", *(method.name for method in ablations(METHODS["fused"]))]
    assert all(list(test["methods"]) == names for test in found)


def test_a_broken_pose_costs_its_own_queries_alone(evaluated: Evaluated, tmp_path: Path) -> None:
    folder, out = own(evaluated, tmp_path)
    (folder / "posed/fish/pose_01.ply").write_bytes(b"ply")
    assert run("evaluate", folder, "--out", out, "--method", "hks").exit_code == 0
    before, after = (results(path)["tests"][0]["methods"]["hks"]["map"] for path in (evaluated[1], out))
    for row in TRANSFORMATIONS:
        if row in (ISOMETRY, MIXED):  # the fish comes last of three, each time
            assert max(after[row]) <= (100 + 100 / 3) / 2 + 0.01
        else:
            assert after[row] == before[row]


def test_a_broken_rest_pose_is_one_plain_line(evaluated: Evaluated, tmp_path: Path) -> None:
    folder, out = own(evaluated, tmp_path)
    (folder / "posed/fish/pose_00.ply").write_bytes(b"")
    result = run("evaluate", folder, "--out", out, "--method", "hks")
    assert result.exit_code == 1
    assert "posed/fish/pose_00.ply: empty: " in plain_line(result)


def test_a_folder_without_models_is_one_plain_line(tmp_path: Path) -> None:
    result = run("evaluate", tmp_path, "--out", tmp_path / "out")
    assert result.exit_code == 1
    assert "holds no posed/NAME/pose_00.ply" in plain_line(result)
    assert not (tmp_path / "out").exists()


def test_an_unknown_method_is_one_plain_line(tmp_path: Path) -> None:
    result = run("evaluate", make_folder(tmp_path / "in"), "--out", tmp_path / "out", "--method", "nose")
    assert result.exit_code == 1
    assert "no method is called 'nose'" in plain_line(result)
    assert not (tmp_path / "out").exists()


def test_ctrl_c_leaves_what_the_same_command_goes_on_from(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stopped(*_: object) -> Iterator[int]:
        yield 1
        raise KeyboardInterrupt

    monkeypatch.setattr(evaluating, "describe_all", stopped)
    result = run("evaluate", make_folder(tmp_path / "in"), "--out", tmp_path / "out")
    assert result.exit_code == 130
    assert "the same command goes on from here" in plain_line(result)
