"""What the fuzz found, kept for a test: the files of each failing mutant and what went wrong."""

import re
from pathlib import Path

from soak.fuzzing.mutating import Mutant


def keep(mutant: Mutant, failure: str, folder: Path) -> Path:
    """Write a mutant's files, and a text that names it.

    Files are numbered, since a mutant's names may be such that no file system takes them; the text
    lists the names.

    Returns
    -------
    Path
        The folder of this mutant.
    """
    safe = re.sub(r"[^A-Za-z0-9.]+", "-", mutant.seed)[-80:]
    place = folder / f"{safe}-{mutant.number}"
    place.mkdir(parents=True, exist_ok=True)
    lines = [f"seed {mutant.seed}, number {mutant.number}, allow_untextured {mutant.allow_untextured}"]
    for position, (name, data) in enumerate(mutant.files.items()):
        (place / f"{position}.bin").write_bytes(data)
        lines.append(f"{position}.bin: {name[:300]!r}")
    (place / "failure.txt").write_text(
        "\n".join([*lines, "", failure]), encoding="utf-8", errors="backslashreplace"
    )
    return place
