"""What an evaluation has described already, so that a stopped or repeated one goes on."""

import hashlib
import json
import os
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from service.evaluation.protocol import VERSION, Recipe
from service.evaluation.sources import MADE, companions_of
from worker.arrays import SingleArray

REFUSED = "refused"  # name of the text that stands in for the blocks of a refused mesh


@dataclass(frozen=True, kw_only=True, eq=False)
class Described:
    """The blocks of one mesh, or why it has none."""

    blocks: dict[str, SingleArray]
    refused: str | None = None  # the reason


class Cache:
    """A folder with one file for each mesh.

    Parameters
    ----------
    path : Path
        Where they are.
    folder : Path
        Of the evaluation: a mesh that changes there is described anew.
    versions : tuple of str
        What else the numbers follow from: the fingerprint of the parameters, the vocabulary.
    """

    def __init__(self, path: Path, folder: Path, versions: tuple[str, ...]) -> None:
        self._path = path
        self._folder = folder
        self._versions = [VERSION, *versions]
        self._digests: dict[str, str] = {}
        path.mkdir(parents=True, exist_ok=True)

    def __contains__(self, recipe: Recipe) -> bool:
        return self._file(recipe).exists()

    def load(self, recipe: Recipe) -> Described:
        """Read what `store` wrote."""
        with np.load(self._file(recipe), allow_pickle=False) as arrays:
            blocks = {name: arrays[name] for name in arrays.files}
        refused = blocks.pop(REFUSED, None)
        return Described(blocks=blocks, refused=None if refused is None else str(refused))

    def store(self, recipe: Recipe, described: Described) -> None:
        """Write aside and rename, so that a file is whole or not there."""
        file = self._file(recipe)
        aside = file.with_suffix(f".{os.getpid()}")
        refused = {} if described.refused is None else {REFUSED: np.array(described.refused)}
        with aside.open("wb") as stream:
            np.savez(stream, allow_pickle=False, **described.blocks, **refused)
        aside.replace(file)

    def _file(self, recipe: Recipe) -> Path:
        source = recipe.geometry.source
        text = json.dumps([*self._versions, self._digest(source), asdict(recipe)])
        return self._path / f"{hashlib.sha256(text.encode()).hexdigest()[:32]}.npz"

    def _digest(self, source: str) -> str:
        if source not in self._digests:
            text = source if source.startswith(MADE) else _state(self._folder / source)
            self._digests[source] = hashlib.sha256(text.encode()).hexdigest()
        return self._digests[source]


def _state(mesh: Path) -> str:
    """Return what changes when a mesh does, or something that it may refer to: content, or size and time."""
    stats = {name: path.stat() for name, path in companions_of(mesh).items()}
    beside = [(name, stat.st_size, stat.st_mtime_ns) for name, stat in stats.items()]
    return json.dumps([hashlib.sha256(mesh.read_bytes()).hexdigest(), *beside])
