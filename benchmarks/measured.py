"""What `make bench` has measured, kept in docs/speed.json: rows by table, and on which machine."""

import json
import os
import platform
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from benchmarks.pages import Row, table_of

CPUINFO = Path("/proc/cpuinfo")  # on Linux

Measured = dict[str, Mapping[str, Any]]  # table → its machine and rows


def read_measured(path: Path) -> Measured:
    """Return what is kept; nothing where there is no file yet."""
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def keep_measured(path: Path, table: str, rows: Sequence[Row]) -> Measured:
    """Replace one table by what was measured just now; return all."""
    measured = read_measured(path)
    measured[table] = {"machine": machine(), "rows": [dict(row) for row in rows]}
    path.write_text(json.dumps(measured, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    return measured


def as_table(measured: Mapping[str, Any]) -> str:
    """Return rows in Markdown, with a line on the machine."""
    return f"{table_of(measured['rows'])}\n{measured['machine']}\n"


def machine() -> str:
    """Say on what, and when."""
    cores, python = os.cpu_count(), platform.python_version()
    return f"{processor()}, {cores} cores, Python {python}, {datetime.now(UTC):%Y-%m-%d}."


def processor() -> str:
    """Return the name of the processor, or at least its kind."""
    lines = CPUINFO.read_text(encoding="utf-8").splitlines() if CPUINFO.exists() else []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return next(filter(None, [*names, platform.processor(), platform.machine()]), "an unknown processor")
