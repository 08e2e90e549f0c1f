"""Descriptions that wait, in whatever process, until a test lets them go on."""

import os
import time
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

from tests.fakes import describe_quickly
from worker.describe import Description


class Gate:
    """Descriptions that wait until it is opened."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.describe = partial(describe_at_a_gate, folder)

    def tried(self) -> int:
        """Return how many descriptions were begun."""
        return len(list(self.folder.glob("*.ply-*")))

    def open(self) -> None:
        """Let them go on."""
        (self.folder / "open").touch()


def describe_at_a_gate(
    folder: Path, files: Mapping[str, Any], allow_untextured: bool, parameters: Any, limits: Any
) -> Description:
    """Leave a mark in a folder for each attempt; describe when the gate is open."""
    (folder / f"{next(iter(files))}-{os.getpid()}").touch()
    while not (folder / "open").exists():
        time.sleep(0.02)
    return describe_quickly(files, allow_untextured, parameters, limits)
