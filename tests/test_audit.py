"""An audit that could ask nobody does not say that all is well."""

import json
import sys
from pathlib import Path
from typing import Any

import pytest

from soak.audit import audit, read_report

CLEAN = {"name": "a", "version": "1", "vulns": []}
HOLED = {"name": "b", "version": "2", "vulns": [{"id": "PYSEC-1", "fix_versions": ["2.1"]}]}
SKIPPED = {"name": "c", "skip_reason": "not found"}


def report(*packages: dict[str, Any]) -> dict[str, Any]:
    return {"dependencies": list(packages), "fixes": []}


def test_a_known_hole_is_named_with_its_remedy() -> None:
    found = read_report(report(CLEAN, HOLED, SKIPPED))
    assert found.holes == ("b 2: PYSEC-1, mended in 2.1",)
    assert (found.clean, found.unasked) == (1, 1)
    assert "PYSEC-1" in found.sentence()


def test_what_nobody_could_be_asked_about_is_not_called_clean() -> None:
    assert "1 packages were not audited" in read_report(report(SKIPPED)).sentence()
    assert "No hole is known in 1 packages; 1 could" in read_report(report(CLEAN, SKIPPED)).sentence()


@pytest.mark.parametrize(
    ("script", "clean", "unasked"),
    [
        ("sys.exit(1)", 0, 2),
        (f"open(sys.argv[-1], 'w').write({json.dumps(json.dumps(report(CLEAN, CLEAN)))})", 2, 0),
    ],
)
def test_a_missing_report_means_that_nobody_answered(
    tmp_path: Path, script: str, clean: int, unasked: int
) -> None:
    lock = tmp_path / "lock"
    lock.write_text("a==1\nb==2\n")
    found = audit(lock, (sys.executable, "-c", f"import sys; {script}"))
    assert (found.clean, found.unasked, found.holes) == (clean, unasked, ())
