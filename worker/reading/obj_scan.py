"""A quick look at an OBJ file: which files and materials it names, without reading its numbers."""

import re
from collections.abc import Iterator

from worker.reading.mtl import decode_text

_FACE = re.compile(rb"\n[ \t]*f[ \t]")
_FACE_WITH_UV = re.compile(rb"\n[ \t]*f[ \t]+-?\d+/-?\d")


def named_libraries(text: bytes) -> list[str]:
    """Return what stands after each mtllib.

    Parameters
    ----------
    text : bytes
        Lines ended by line feeds.
    """
    return [rest for rest, _ in _lines_of(text, b"mtllib")]


def used_materials(text: bytes) -> dict[str, bool]:
    """Return the materials of faces, and whether a face of each has texture coordinates.

    Parameters
    ----------
    text : bytes
        Lines ended by line feeds.
    """
    has_uvs = b"\nvt" in text
    lines = list(_lines_of(text, b"usemtl"))
    following = [start for _, start in lines[1:]] + [len(text)]
    used: dict[str, bool] = {}
    for (name, start), end in zip(lines, following, strict=False):
        if used.get(name) or _FACE.search(text, start, end) is None:
            continue
        used[name] = has_uvs and _FACE_WITH_UV.search(text, start, end) is not None
    return used


def _lines_of(text: bytes, keyword: bytes) -> Iterator[tuple[str, int]]:
    """Yield what stands after a keyword, and where that line ends."""
    found = text.find(keyword)
    while found >= 0:
        start = text.rfind(b"\n", 0, found) + 1
        end = text.find(b"\n", found)
        end = len(text) if end < 0 else end
        after = found + len(keyword)
        if not text[start:found].strip() and text[after : after + 1] in {b" ", b"\t", b"\n", b""}:
            yield decode_text(text[after:end]).strip(), end
        found = text.find(keyword, max(end, after))
