"""docs/promises.md: what is promised, what proves it, and what the last soak found."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from benchmarks.pages import fill_page, markdown

DOCS = Path(__file__).parents[1] / "docs"
PAGE, KEPT = DOCS / "promises.md", DOCS / "promises.json"


@dataclass(frozen=True, kw_only=True)
class Promise:
    """A row of the page."""

    text: str  # for whoever uploads years of work
    tests: tuple[str, ...]  # files in tests/, without their ending
    parts: tuple[str, ...] = ()  # of the soak


PROMISES = (
    Promise(
        text="What was acknowledged with 2xx survives `kill -9` of every process at any moment.",
        tests=("test_crashes", "test_files", "test_server", "test_acceptance"),
        parts=("kills",),
    ),
    Promise(
        text="Every job ends `ready` or `failed`, stored once, however often workers die or sleep.",
        tests=("test_crashes", "test_workers", "test_queue", "test_recording"),
        parts=("kills",),
    ),
    Promise(
        text="A failed or cut upload leaves nothing behind and blocks no retry.",
        tests=("test_uploads", "test_multipart", "test_incoming"),
        parts=("cuts",),
    ),
    Promise(
        text="Stalled clients hold up nobody, and are let go of.",
        tests=("test_uploads", "test_connections"),
        parts=("stalls",),
    ),
    Promise(
        text="Uploads at the same time are kept once each, or told to come back.",
        tests=("test_uploads", "test_acceptance"),
        parts=("crowd",),
    ),
    Promise(
        text="The index answers as brute force over the catalogue would; a damaged index file is rebuilt.",
        tests=("test_searcher", "test_index_file", "test_ranking", "test_crashes"),
        parts=("kills",),
    ),
    Promise(
        text="One bad mesh harms only itself: it is refused with a code, in the reply or as `failed`.",
        tests=("test_odd_meshes", "test_odd_meshes_over_http", "test_fuzz", "test_pool", "test_workers"),
        parts=("mutants",),
    ),
    Promise(
        text="A full disk refuses uploads (507), keeps answering, can be emptied, and recovers by itself.",
        tests=("test_small_disk", "test_reserve", "test_full_disk"),
        parts=("full_disk",),
    ),
    Promise(
        text="A catalogue that another program locks keeps answering; changes are told to come back (503).",
        tests=("test_locked", "test_database"),
        parts=("lock",),
    ),
    Promise(
        text="Every answer is as the interface describes it; an error is never a traceback.",
        tests=("test_contract", "test_openapi", "test_errors", "test_hostile_requests"),
        parts=("contract",),
    ),
    Promise(
        text="Nobody gets in without a key where keys are asked for; a key does what its scope says.",
        tests=("test_guards", "test_keys", "test_key_ring", "test_listening", "test_upload_rate"),
        parts=("contract",),
    ),
    Promise(
        text="A library comes back whole from an export, also in a later version; a damaged file is refused.",
        tests=("test_exporting", "test_importing", "test_checking", "test_commands_export"),
    ),
)


def keep(part: str, figures: str, broken: int, seed: int) -> None:
    """Keep what a part found, in place of what it found before, and fill the page."""
    found = read_kept()
    day = f"{datetime.now(UTC):%Y-%m-%d}"
    found[part] = {"figures": figures, "broken": broken, "seed": seed, "day": day}
    KEPT.write_text(json.dumps(found, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    fill_page(PAGE, {"promises": table(found)})


def read_kept() -> dict[str, dict[str, str | int]]:
    """Return what is kept, by part."""
    return json.loads(KEPT.read_text(encoding="utf-8")) if KEPT.exists() else {}


def table(found: Mapping[str, Mapping[str, str | int]]) -> str:
    """Return the page's table."""
    lines = [[promise.text, _tests(promise), _figures(promise, found)] for promise in PROMISES]
    return markdown(["promise", "tests", "last soak"], ["---"] * 3, lines)


def _tests(promise: Promise) -> str:
    return ", ".join(f"[{name.removeprefix('test_')}](../tests/{name}.py)" for name in promise.tests)


def _figures(promise: Promise, found: Mapping[str, Mapping[str, str | int]]) -> str:
    told = [
        f"`{part}`: {found[part]['figures']}; **{found[part]['broken']} broken** ({found[part]['day']})"
        for part in promise.parts
        if part in found
    ]
    return "<br>".join(told) or "-"
