"""Every number has its question in the manual, and every one of the manual exists."""

import re
from pathlib import Path

from service.watching.library_numbers import LibraryNumbers
from service.watching.metrics import Metrics
from tests.serving import open_fake_library, settings_for

MANUAL = Path(__file__).parents[1] / "docs" / "operating.md"


def families(folder: Path) -> dict[str, str]:
    """Return the name of each family, as it is scraped, and its type."""
    library = open_fake_library(settings_for(folder))
    metrics = Metrics()
    metrics.watch(LibraryNumbers(library))
    found = {
        each.name + ("_total" if each.type == "counter" else ""): each.type for each in metrics.collect()
    }
    library.close()
    return found


def test_the_manual_tells_every_number_and_no_other(tmp_path: Path) -> None:
    rows = [line for line in MANUAL.read_text().splitlines() if line.startswith("| ")]
    told = {name for row in rows for name in re.findall(r"`(faience_\w+)`", row.split("|")[2])}
    assert told == set(families(tmp_path / "library"))


def test_alerts_ask_for_numbers_that_exist(tmp_path: Path) -> None:
    known = set()
    for name, kind in families(tmp_path / "library").items():
        known |= {f"{name}_bucket", f"{name}_count", f"{name}_sum"} if kind == "histogram" else {name}
    alerts = MANUAL.read_text().partition("```yaml")[2].partition("```")[0]
    asked = set(re.findall(r"faience_\w+", alerts))
    assert len(asked) > 5
    assert asked <= known


def test_jobs_are_counted_by_outcome_with_their_time() -> None:
    metrics = Metrics()
    metrics.observe_job("ready", 2.0)
    text = metrics.text().decode()
    assert 'faience_jobs_total{outcome="ready"} 1.0' in text
    assert "faience_job_seconds_sum 2.0" in text
