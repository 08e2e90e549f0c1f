"""What the library is made of: files as a user would send them, with a name."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Sample:
    """One coloured mesh made by code, ready to be uploaded."""

    name: str  # shown in the library, unique in it
    files: Mapping[str, bytes]  # file name → content: one PLY, or an OBJ with its MTL and PNG
    metadata: Mapping[str, str]  # kind, pose, colouring …
