"""Known holes in what Faience is built on: `python -m soak.audit requirements.lock`.

pip-audit says that nothing is known, too, where nobody could be asked. Here that is said as it is.
"""

import contextlib
import json
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

PATIENCE = 120.0  # seconds for all packages
COMMAND = (sys.executable, "-m", "pip_audit", "--no-deps", "--disable-pip", "--progress-spinner", "off")


@dataclass(frozen=True, kw_only=True)
class Audit:
    """What the advisories say."""

    clean: int  # packages of which no hole is known
    unasked: int  # packages of which nothing could be learnt
    holes: tuple[str, ...]  # package, version and advisory

    def sentence(self) -> str:
        """Return the outcome in words."""
        if self.holes:
            return "Known holes:\n  " + "\n  ".join(self.holes)
        if not self.clean:
            return f"No source of advisories could be reached: {self.unasked} packages were not audited."
        return f"No hole is known in {self.clean} packages; {self.unasked} could not be audited."


def audit(lock: Path, command: Sequence[str] = COMMAND) -> Audit:
    """Ask for the advisories of every pinned package.

    Parameters
    ----------
    lock : Path
        Lines of ``name==version``.
    command : sequence of str
        pip-audit, without the options that say what to read and what to write.
    """
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder, "report.json")
        options = ("--requirement", str(lock), "--format", "json", "--output", str(report))
        with contextlib.suppress(subprocess.TimeoutExpired):  # as if nobody had answered
            subprocess.run([*command, *options], capture_output=True, timeout=PATIENCE, check=False)
        if not report.exists():
            return Audit(clean=0, unasked=len(lock.read_text(encoding="utf-8").split()), holes=())
        return read_report(json.loads(report.read_text(encoding="utf-8")))


def read_report(report: Mapping[str, Any]) -> Audit:
    """Return what pip-audit's report says."""
    packages = report["dependencies"]
    asked = [package for package in packages if "skip_reason" not in package]
    holes = tuple(
        f"{package['name']} {package['version']}: {hole['id']}, mended in {remedy(hole)}"
        for package in asked
        for hole in package["vulns"]
    )
    clean = sum(not package["vulns"] for package in asked)
    return Audit(clean=clean, unasked=len(packages) - len(asked), holes=holes)


def remedy(hole: Mapping[str, Any]) -> str:
    """Return the versions in which a hole is mended."""
    return ", ".join(hole["fix_versions"]) or "no version yet"


if __name__ == "__main__":
    found = audit(Path(sys.argv[1]))
    print(found.sentence())
    sys.exit(bool(found.holes))
