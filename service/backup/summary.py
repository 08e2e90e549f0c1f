"""What came of an export or an import."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Damage:
    """A file that is not what the catalogue says, although nobody changed its shape."""

    code: str  # file_missing, file_unreadable, file_altered, rows_damaged
    shape: str | None  # id of whose it is; None where it concerns the catalogue
    what: str  # the key of the file, or what is wrong with the rows in words


@dataclass(frozen=True, kw_only=True)
class Summary:
    """What was carried over."""

    shapes: int
    files: int
    bytes: int  # of the exported file
    left_out: tuple[str, ...] = ()  # ids of shapes that were removed or sent anew meanwhile
    damaged: tuple[Damage, ...] = ()  # what is damaged in the library itself, carried over as it is
