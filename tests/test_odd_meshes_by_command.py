"""`faience index` tells the same outcomes and codes of odd meshes as HTTP does."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from service.commands import opening
from tests.commanding import json_lines, run
from tests.odd_meshes import ODD, OddMesh, odd_meshes
from tests.small_library import open_small_library

MADE = ODD / "made"


@pytest.fixture(scope="module")
def lines(odd_meshes_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict[str, Any]]:
    """Index every made row in one run; return the line of each, by its entry."""
    assert odd_meshes_folder == ODD
    paths = [MADE / row.entry.split("/")[0] for row in odd_meshes("MADE.tsv")]
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(opening, "Library", SimpleNamespace(open=open_small_library))
        patched.setenv("FAIENCE_POLL_SECONDS", "0.05")
        result = run("index", *paths, "--data-dir", tmp_path_factory.mktemp("library"), "--json")
    assert result.exit_code == 0
    *told, total = json_lines(result)
    assert total["accepted"] + total["known"] + total["refused"] == len(told)
    return {Path(line["path"]).relative_to(MADE).as_posix(): line for line in told}


@pytest.mark.parametrize("row", odd_meshes("MADE.tsv"), ids=lambda row: str(row.entry))
def test_a_made_row_has_its_outcome_and_code(lines: dict[str, dict[str, Any]], row: OddMesh) -> None:
    line = lines[row.entry]
    if row.accepted:
        assert (line["outcome"] in {"accepted", "known"}, line["code"]) == (True, None)
    else:
        assert line["outcome"] == "refused"
        assert line["code"] in row.codes


def test_there_is_a_line_for_each_row_and_no_other(lines: dict[str, dict[str, Any]]) -> None:
    assert lines.keys() == {row.entry for row in odd_meshes("MADE.tsv")}
