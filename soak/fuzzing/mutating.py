"""Mutants: uploads made of seeds, each the same again from its number."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from random import Random

from soak.fuzzing import containers, damage, naming, wording
from soak.fuzzing.seeds import Files

ChangeBytes = Callable[[bytes, Random], bytes]
ChangeFiles = Callable[[Files, Random], Files]

ANY: tuple[ChangeBytes, ...] = (
    damage.flip_bit,
    damage.set_byte,
    damage.write_number,
    damage.remove_piece,
    damage.repeat_piece,
    damage.insert_noise,
    damage.swap_pieces,
    damage.blank_piece,
    damage.truncate,
)
TEXT: tuple[ChangeBytes, ...] = (
    wording.change_number,
    wording.change_number,  # twice: numbers are most of a mesh
    wording.change_word,
    wording.insert_word,
    wording.remove_line,
    wording.repeat_line,
    wording.move_line,
    wording.join_lines,
)
BY_ENDING: Mapping[str, tuple[ChangeBytes, ...]] = {
    "ply": (*TEXT, wording.in_header, wording.in_header, wording.in_header),
    "obj": TEXT,
    "mtl": TEXT,
    "zip": (containers.change_zip_field,) * 8,
    "png": (containers.change_png_chunk,) * 8,
    "jpg": (containers.change_jpeg_field,) * 4,
}
TOGETHER: tuple[ChangeFiles, ...] = (naming.rename, naming.drop, naming.add, naming.exchange)
_PATIENCE = 20  # tries until something is changed


@dataclass(frozen=True, kw_only=True, eq=False)
class Mutant:
    """One damaged upload."""

    seed: str  # name of what it was made of
    number: int
    files: Files
    allow_untextured: bool


class Mutants:
    """Makes mutants of seeds.

    Parameters
    ----------
    seeds : Mapping[str, Files]
        By name; at least one. The same seeds and run give the same mutants.
    run : int
        Another number gives other mutants.
    """

    def __init__(self, seeds: Mapping[str, Files], run: int) -> None:
        self._seeds = seeds
        self._names = sorted(seeds)
        self._run = run
        self._donors = _by_ending(seeds)

    def make(self, number: int) -> Mutant:
        """Make one mutant; the seeds take turns."""
        name = self._names[number % len(self._names)]
        rng = Random(f"{self._run} {name} {number}")
        files = self._seeds[name]
        for _ in range(rng.choice((1, 1, 1, 2, 3, 5))):
            files = self._changed(files, rng)
        return Mutant(seed=name, number=number, files=files, allow_untextured=rng.random() < 0.3)

    def _changed(self, files: Files, rng: Random) -> Files:
        """Do one thing to an upload."""
        for _ in range(_PATIENCE):
            if not files or rng.random() < 0.05:
                changed = rng.choice(TOGETHER)(files, rng) if files else {"a.ply": b""}
            else:
                name = rng.choice(list(files))
                changed = {**files, name: self._damaged(name, files[name], rng)}
            if changed != files:
                return changed
        return {**files, "one more.txt": b""}  # hardly ever: 20 changes in a row changed nothing

    def _damaged(self, name: str, data: bytes, rng: Random) -> bytes:
        ending = _ending(name)
        if rng.random() < 0.1:
            return damage.splice(data, rng.choice(self._donors.get(ending, [b"donor"])), rng)
        if ending == "zip" and rng.random() < 0.5:
            inside = containers.members(data)
            if inside:
                return containers.pack(self._changed(inside, rng), rng)
        own = BY_ENDING.get(ending, ())
        return rng.choice(own if own and rng.random() < 0.6 else ANY)(data, rng)


def _ending(name: str) -> str:
    return name.lower().rpartition(".")[2]


def _by_ending(seeds: Mapping[str, Files]) -> dict[str, list[bytes]]:
    """Return all contents by the ending of their names, in an order of their own."""
    found: dict[str, list[bytes]] = {}
    for name in sorted(seeds):
        for file, data in seeds[name].items():
            found.setdefault(_ending(file), []).append(data)
    return found
