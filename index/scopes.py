"""What the holder of an API key may do."""

from enum import StrEnum


class Scope(StrEnum):
    """How far a key reaches."""

    READ = "read"  # whatever changes nothing: look, list, search
    WRITE = "write"  # everything
