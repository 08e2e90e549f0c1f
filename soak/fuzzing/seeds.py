"""Where mutants come from: small uploads found in folders, and uploads written in code."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from service.commands.companions import Companions
from service.commands.discovery import find_sources
from soak.fuzzing.written import written_seeds
from worker.reading.limits import Limits

Files = Mapping[str, bytes]
LARGEST = 60_000  # bytes of an upload: what is larger makes mutants slow, not odd


def collect_seeds(folders: Iterable[Path], largest: int = LARGEST) -> dict[str, Files]:
    """Return the uploads that are mutated, by name.

    Parameters
    ----------
    folders : Iterable[Path]
        Every mesh and zip below them is a seed with the files that it names; good ones and bad ones.
    largest : int
        Bytes of an upload; greater ones are left out.
    """
    seeds = dict(written_seeds())
    for folder in folders:
        seeds.update(_found(folder, largest))
    return {name: files for name, files in seeds.items() if sum(map(len, files.values())) <= largest}


def _found(folder: Path, largest: int) -> dict[str, Files]:
    found: dict[str, Files] = {}
    for source in find_sources([folder]):
        companions = Companions(source, Limits())
        for mesh in source.meshes:
            if mesh.path.stat().st_size <= largest:
                paths = companions.files_of(mesh)
                name = f"{folder.name}/{mesh.place}"
                found[name] = {place: path.read_bytes() for place, path in paths.items()}
    return found
