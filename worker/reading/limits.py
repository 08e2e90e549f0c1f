"""How much is accepted: bounds that hold before anything is allocated."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Limits:
    """Bounds on one upload."""

    faces: int = 5_000_000  # triangles after splitting polygons
    image_pixels: int = 40_000_000  # of one image, checked before it is decoded
    archive_entries: int = 1_000  # files in a zip
    unpacked_bytes: int = 1_000_000_000  # all files of a zip together, counted while reading
