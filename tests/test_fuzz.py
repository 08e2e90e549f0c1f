"""The fuzz finds what is planted, names it, and finds nothing in the readers as they are."""

from collections.abc import Mapping
from pathlib import Path
from random import Random

import pytest

from soak.fuzz import FuzzResult, lines_of, run
from soak.fuzzing import containers, naming
from soak.fuzzing.child import Order
from soak.fuzzing.findings import keep
from soak.fuzzing.judging import ACCEPTED, Reader, judge
from soak.fuzzing.mutating import ANY, BY_ENDING, TOGETHER, ChangeBytes, ChangeFiles, Mutant, Mutants
from soak.fuzzing.seeds import collect_seeds
from soak.fuzzing.watching import Judged, watch
from tests import planted_readers

SEEDS = collect_seeds([])
GOOD = Mutant(seed="written/coloured", number=0, files=SEEDS["written/coloured"], allow_untextured=False)
EVERY_CHANGE = tuple(dict.fromkeys([*ANY, *(each for own in BY_ENDING.values() for each in own)]))


def drawn(seed: int) -> Random:
    return Random(seed)  # noqa: S311 - mutants are no secret


def test_the_readers_keep_their_promises() -> None:
    mutants = Mutants(SEEDS, run=2011)
    failures = []
    outcomes = set()
    for number in range(400):
        verdict = judge(mutants.make(number), again=number % 10 == 0)
        outcomes.add(verdict.outcome)
        if verdict.failure:
            failures.append((number, verdict))
    assert failures == []
    assert ACCEPTED in outcomes
    assert len(outcomes) > 10  # the mutants reach many refusals, not the first alone


def test_every_seed_is_a_mesh_to_begin_with() -> None:
    for name, files in SEEDS.items():
        mutant = Mutant(seed=name, number=0, files=files, allow_untextured=False)
        assert judge(mutant).outcome == ACCEPTED, name


def test_mutants_are_the_same_again() -> None:
    first, again, other = (Mutants(SEEDS, run) for run in (1, 1, 2))
    assert [first.make(number).files for number in range(100)] == [
        again.make(number).files for number in reversed(range(100))
    ][::-1]
    assert any(first.make(number).files != other.make(number).files for number in range(20))


def test_mutants_are_no_seeds() -> None:
    mutants = Mutants(SEEDS, run=1)
    made = [mutants.make(number) for number in range(300)]
    same = [mutant for mutant in made if mutant.files == SEEDS[mutant.seed]]
    assert len(same) <= 3  # two changes may undo each other


@pytest.mark.parametrize("change", EVERY_CHANGE, ids=lambda change: change.__name__)
def test_every_change_of_bytes_changes_most_files_of_its_kind(change: ChangeBytes) -> None:
    endings = {ending for ending, own in BY_ENDING.items() if change in own} or {"ply", "obj", "png", "zip"}
    contents = [
        data
        for files in SEEDS.values()
        for name, data in files.items()
        if name.lower().rpartition(".")[2] in endings
    ]
    rng = drawn(5)
    changed = [change(data, rng) != data for data in contents for _ in range(10)]
    assert sum(changed) > len(changed) / 2


@pytest.mark.parametrize("change", EVERY_CHANGE, ids=lambda change: change.__name__)
def test_no_change_minds_an_empty_or_strange_file(change: ChangeBytes) -> None:
    for data in (b"", b"a", b"\xff" * 50):
        for number in range(50):
            assert isinstance(change(data, drawn(number)), bytes)


@pytest.mark.parametrize("change", TOGETHER, ids=lambda change: change.__name__)
def test_every_change_of_an_upload_changes_most_of_them(change: ChangeFiles) -> None:
    rng = drawn(6)
    files = SEEDS["written/rich-obj"]
    changed = [change(files, rng) != files for _ in range(40)]
    assert sum(changed) > 20


def test_a_zip_is_packed_whole_again() -> None:
    inside: Mapping[str, bytes] = containers.members(SEEDS["written/zip-deflated"]["a.zip"])
    assert containers.members(containers.pack(inside, drawn(1))) == inside
    assert containers.members(b"PK\x05\x06") == {}
    odd = {"\udcff.ply": b"1", "a\0b": b"2", "a\0c": b"3", "": b"4"}
    assert containers.members(containers.pack(odd, drawn(1))) == {"?.ply": b"1", "a": b"3", "": b"4"}


def test_a_missing_file_is_named_again() -> None:
    assert naming.drop({"a": b"", "b": b""}, drawn(1)).keys() < {"a", "b"}


@pytest.mark.parametrize(
    ("reader", "told"),
    [
        (planted_readers.forget_a_number, "not finite"),
        (planted_readers.name_a_vertex_too_many, "name vertices"),
        (planted_readers.colour_too_brightly, "corner colours"),
        (planted_readers.raise_what_is_no_refusal, "IndexError"),
        (planted_readers.show_the_inside, "inside of the program"),
        (planted_readers.say_nothing, "empty"),
        (planted_readers.disturb_the_screen, "control characters"),
    ],
)
def test_a_reader_that_breaks_a_promise_is_caught(reader: Reader, told: str) -> None:
    assert judge(GOOD).failure == ""
    assert told in judge(GOOD, reader).failure


def test_two_outcomes_of_the_same_bytes_are_caught() -> None:
    assert "two outcomes" in judge(GOOD, planted_readers.refuse_at_random, again=True).failure


def test_what_is_read_but_refused_by_its_headers_is_caught() -> None:
    nothing = Mutant(seed="none", number=0, files={"m.ply": b""}, allow_untextured=False)
    assert "refused by its headers: empty" in judge(nothing, planted_readers.accept_anything).failure


@pytest.mark.parametrize(
    ("reader", "outcome", "told"),
    [
        ("crash", "crash", "Segmentation fault"),
        ("hang", "hang", "no answer"),
        ("spin", "hang", "processor time"),
        ("eat_memory", "raised", "MemoryError"),
    ],
)
def test_a_process_that_goes_wrong_costs_one_mutant(reader: str, outcome: str, told: str) -> None:
    order = Order(
        folders=(),
        run=1,
        first=3,
        end=4,
        reader=f"tests.planted_readers:{reader}",
        whole_every=0,
        cpu_seconds=1 if reader == "spin" else 60,
        memory_bytes=2**28,
    )
    (judged,) = list(watch(order, silence=2.0 if reader == "hang" else 60.0))
    assert (judged.number, judged.outcome) == (3, outcome)
    assert told in judged.failure


def test_the_mutant_after_a_crash_is_judged_too() -> None:
    order = Order(
        folders=(), run=1, first=3, end=8, step=2, reader="tests.planted_readers:crash", whole_every=0
    )
    assert [one.number for one in watch(order)] == [3, 5, 7]


def test_compiled_loops_that_leave_their_arrays_are_caught(tmp_path: Path) -> None:
    order = Order(
        folders=(), run=1, first=0, end=1, reader="tests.planted_readers:read_beyond", whole_every=0
    )
    (judged,) = watch(order, bounds=tmp_path)
    assert "IndexError: index is out of bounds" in judged.failure


def test_a_run_counts_and_tells(tmp_path: Path) -> None:
    told: list[str] = []
    result = run(60, seed=3, report=told.append, failures_in=tmp_path, checked=False)
    assert result.mutants == 60 == result.accepted + sum(result.refused.values())
    assert result.failures == ()
    assert list(lines_of(result)) == told
    assert "60 mutants" in told[0]
    assert list(tmp_path.iterdir()) == []


def test_failing_mutants_are_kept_with_their_files(tmp_path: Path) -> None:
    mutant = Mutants(SEEDS, run=1).make(12)
    place = keep(mutant, "crash: it died", tmp_path)
    kept = [(place / f"{number}.bin").read_bytes() for number in range(len(mutant.files))]
    assert kept == list(mutant.files.values())
    assert f"number {mutant.number}" in (place / "failure.txt").read_text(encoding="utf-8")
    assert "it died" in (place / "failure.txt").read_text(encoding="utf-8")


def test_failures_are_told_with_their_number() -> None:
    failure = Judged(number=7, outcome="crash", failure="died\nSegmentation fault", seed="a")
    result = FuzzResult(
        mutants=1, refused={}, accepted=0, described=0, failures=(failure,), seconds=1.0, slowest=failure
    )
    assert any("number 7" in line and "Segmentation fault" in line for line in lines_of(result))
