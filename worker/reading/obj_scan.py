"""A quick look at an OBJ file: which files and materials it names, without reading its numbers."""

import re
from collections.abc import Iterator

from worker.reading.mtl import decode_text

_UV = re.compile(rb"\n[ \t]*vt[ \t]")
_BLANKS = b" \t\n\v\f"
# Whole faces only: one that reading would drop, or take for one without texture coordinates, needs no image.
_FACE = re.compile(rb"\n[ \t]*f(?:[ \t]+[^\s#]+){3}")
_FACE_WITH_UV = re.compile(rb"\n[ \t]*f(?:[ \t]+[-+]?\d+/[-+]?\d+(?:/[-+]?\d*)?){3,}+[ \t]*(?:[\n#]|$)")


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
    has_uvs = _UV.search(text) is not None
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
        if not text[start:found].strip() and text[after : after + 1] in _BLANKS:
            yield decode_text(text[after:end]).strip(), end
        found = text.find(keyword, max(end, after))
