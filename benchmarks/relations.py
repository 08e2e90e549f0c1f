"""Fill the tables of docs/relations.md: `python -m benchmarks.relations FOLDER`.

What is described is kept, so that a stopped run goes on from there.
"""

import argparse
import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from itertools import combinations_with_replacement
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from benchmarks.pages import fill_page, table_of
from benchmarks.relation_meshes import Read, Variant, surfaces
from benchmarks.relation_numbers import Kept, describe_all
from benchmarks.relation_telling import Pair, Told, told_of
from benchmarks.relation_truth import ALIASES, Moves, moves_of, truth
from service.commands.opening import pool_for
from service.relations.relation import Relation
from service.settings import Settings

PAGE = Path(__file__).parents[1] / "docs" / "relations.md"
PRELOAD = ("benchmarks.relation_numbers", "benchmarks.relation_telling", "benchmarks.relation_truth")
HOUR = 3_600  # seconds that one process may take: the machine may be busy
GROUPS = 4  # of pairs, for one process after another


def main() -> None:
    """Describe, compare, fill in."""
    options = _options()
    start = time.perf_counter()
    found = surfaces(options.folder)
    kept = Kept(path=options.cache)
    settings = Settings(workers=options.workers, job_seconds=HOUR, job_cpu_seconds=HOUR)
    with threadpool_limits(1), pool_for(settings, PRELOAD) as pool:
        describe_all(pool, kept, found.values())
        told = list(measure(pool, kept, found))
    tables = tables_of(told)
    fill_page(options.page, tables)
    print(f"{options.page.name}: {', '.join(tables)}; {time.perf_counter() - start:.0f} s")


def measure(
    pool: Executor, kept: Kept, found: Mapping[Variant, tuple[Read, Sequence[Variant]]]
) -> Iterator[Told]:
    """Compare the pairs of each part."""
    moves = _moves(pool, found)
    for part in dict.fromkeys(variant.part for variant in found):
        variants = [each for _, sharing in found.values() for each in sharing if each.part == part]
        pairs = list(pairs_of(variants, {each: kept.change(each) for each in variants}, moves))
        groups = [pairs[start::GROUPS] for start in range(GROUPS)]
        for group in pool.map(told_of, [kept] * GROUPS, groups):
            yield from group


def pairs_of(variants: Sequence[Variant], changes: Mapping[Variant, float], moves: Moves) -> Iterator[Pair]:
    """Yield pairs whose relation is known: all of one model, and of others those in their own colours."""
    for one, other in combinations_with_replacement(variants, 2):
        related = ALIASES.get(one.model, one.model) == ALIASES.get(other.model, other.model)
        own = one.coat == other.coat == "own"
        if related or own:
            relation = truth(one, other, changes, moves)
            if relation is not None and (one != other or own):
                yield one, other, relation


def _moves(pool: Executor, found: Mapping[Variant, tuple[Read, Sequence[Variant]]]) -> Moves:
    """Measure how far the poses of each model lie apart."""
    models: dict[str, dict[tuple[str, str], Read]] = {}
    for variant, (read, _) in found.items():
        if variant.form == "plain" and not variant.cut:
            alias = ALIASES.get(variant.model, variant.model)
            models.setdefault(alias, {})[variant.model, variant.pose] = read
    measured = pool.map(moves_of, models.values())
    return {pair: moved for moves in measured for pair, moved in moves.items()}


def tables_of(told: Sequence[Told]) -> dict[str, str]:
    """Return the tables by their markers: of each part what was told of what, and how well."""
    tables = {"cost": table_of(list(_costs(told)))}
    for part in dict.fromkeys(each.part for each in told):
        counts = Counter((each.true, each.told) for each in told if each.part == part)
        tables[part] = table_of(list(scores(counts)))
        tables[f"{part}-pairs"] = table_of(list(confusion(counts)))
    return tables


def scores(counts: Mapping[tuple[Relation, str], int]) -> Iterator[dict[str, str]]:
    """Yield precision and recall of each relation."""
    for relation in Relation:
        right = counts.get((relation, str(relation)), 0)
        told = sum(count for (_, name), count in counts.items() if name == relation)
        true = sum(count for (name, _), count in counts.items() if name == relation)
        yield {
            "relation": f"`{relation}`",
            "precision": f"{right / told:.3f}" if told else "",
            "recall": f"{right / true:.3f}" if true else "",
            "pairs": str(true),
        }


def confusion(counts: Mapping[tuple[Relation, str], int]) -> Iterator[dict[str, str]]:
    """Yield for each true relation how many pairs were told to have which."""
    for true in Relation:
        told = {f"`{name}`": str(counts.get((true, str(name)), 0)) for name in Relation}
        yield {"true \\ told": f"`{true}`", **told}


def _costs(told: Sequence[Told]) -> Iterator[dict[str, str]]:
    for relation in Relation:
        spent = [each.milliseconds for each in told if each.told == relation]
        if spent:
            median, most = np.percentile(spent, [50, 95])
            yield {"told": f"`{relation}`", "median, ms": f"{median:.2f}", "95 %, ms": f"{most:.2f}"}


def _options() -> argparse.Namespace:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("folder", type=Path, help="as for `faience evaluate`")
    arguments.add_argument("--cache", type=Path, default=Path("faience-relations"))
    arguments.add_argument("--page", type=Path, default=PAGE, help="whose tables are filled")
    arguments.add_argument("--workers", type=int, default=2)
    return arguments.parse_args()


if __name__ == "__main__":
    main()
