"""The sample library: who is in it, in which poses and coats."""

from collections.abc import Iterator
from dataclasses import dataclass

from service.samples.creatures import KINDS, make_creature
from service.samples.palettes import COATS
from service.samples.sample import Sample
from service.samples.texturing import obj_files
from service.samples.writing import ply_bytes


@dataclass(frozen=True, kw_only=True)
class Character:
    """One creature of the library."""

    name: str  # shown, with the pose
    kind: str  # a key of KINDS
    coat: str  # a key of COATS
    textured: bool = False  # an OBJ with MTL and PNG instead of a PLY with vertex colours


CHARACTERS = (
    Character(name="giraffe", kind="grazer", coat="savannah"),
    Character(name="tiger cub", kind="walker", coat="tiger", textured=True),
    Character(name="gecko", kind="lizard", coat="jungle"),
    Character(name="parrot", kind="bird", coat="parrot"),
    Character(name="octopus", kind="octopus", coat="deep sea"),
    Character(name="reef fish", kind="fish", coat="reef"),
    Character(name="zebra giraffe", kind="grazer", coat="zebra"),  # the giraffe, recoloured
    Character(name="ember gecko", kind="lizard", coat="ember"),  # the gecko, recoloured
)


def make_samples() -> Iterator[Sample]:
    """Make the library: eight creatures in four poses, two of them recoloured twins of two others.

    Each pose is tessellated anew, with another number of vertices.
    """
    for character in CHARACTERS:
        for number, pose in enumerate(KINDS[character.kind].poses):
            yield _sample(character, pose, number)


def count_samples() -> int:
    """Return how many samples `make_samples` makes."""
    return sum(len(KINDS[character.kind].poses) for character in CHARACTERS)


def _sample(character: Character, pose: str, number: int) -> Sample:
    kind = KINDS[character.kind]
    shell = make_creature(
        character.kind,
        COATS[character.coat],
        kind.poses[pose],
        n_vertices=6400 - 500 * number,
        offset=0.27 * number,
    )
    stem = f"{character.name} {pose}".replace(" ", "-")
    files = obj_files(shell, stem) if character.textured else {f"{stem}.ply": ply_bytes(shell)}
    metadata = {"creature": character.name, "kind": character.kind, "pose": pose, "coat": character.coat}
    return Sample(name=f"{character.name}, {pose}", files=files, metadata=metadata)
