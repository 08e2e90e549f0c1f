"""The header of a PLY file: what it promises, checked before anything is read or allocated."""

from dataclasses import dataclass

from worker.errors import Code, MeshError
from worker.reading.contents import among
from worker.reading.limits import Limits
from worker.reading.showing import shown

TYPES = dict[str, str](
    char="i1", uchar="u1", short="i2", ushort="u2", int="i4", uint="u4", float="f4", double="f8"
) | dict[str, str](
    int8="i1", uint8="u1", int16="i2", uint16="u2", int32="i4", uint32="u4", float32="f4", float64="f8"
)
BYTE_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
INDEX_NAMES = ("vertex_indices", "vertex_index")  # of the list of a face's corners
_END = b"end_header"
LONGEST_NAME = 100  # characters of an element's name, which messages repeat
_LONGEST = 1 << 20  # bytes of a header


@dataclass(frozen=True, kw_only=True)
class Property:
    """One column of an element, or one list a row."""

    name: str
    type: str  # of the values, as numpy writes it without byte order: "f4"
    count_type: str | None = None  # of a list's length; None where it is no list


@dataclass(frozen=True, kw_only=True)
class Element:
    """One table of the file."""

    name: str
    count: int  # rows
    properties: tuple[Property, ...]

    def least_bytes(self, text: bool) -> int:
        """Return the fewest bytes that a row can take."""
        if text:
            return 2 * len(self.properties)  # a digit and a blank
        return sum(int((field.count_type or field.type)[1]) for field in self.properties)


@dataclass(frozen=True, kw_only=True)
class Header:
    """What a PLY file says of itself."""

    byte_order: str  # "" for text, else "<" or ">"
    elements: tuple[Element, ...]
    texture_files: tuple[str, ...]  # named by comments
    body: int  # position of the first byte after the header
    warnings: tuple[str, ...]

    def element(self, name: str) -> Element | None:
        """Return the element of that name."""
        return next((element for element in self.elements if element.name == name), None)


def read_header(data: bytes) -> Header:
    """Read and check the header.

    Raises
    ------
    MeshError
        EMPTY, NOT_PLY, TRUNCATED, BAD_HEADER
    """
    start = 3 if data.startswith(b"\xef\xbb\xbf") else 0
    if not data[start : start + _LONGEST].strip():
        raise MeshError(Code.EMPTY, "The file is empty.")
    lines, body = _header_lines(data, start)
    builder = _Builder()
    for line in lines[1:]:
        builder.take(line)
    return builder.finish(body)


def _header_lines(data: bytes, start: int) -> tuple[list[str], int]:
    """Return the header's lines without the last, and where the body begins."""
    magic = data[start : start + 4]
    if magic[:3] != b"ply" or (magic[3:] and magic[3:] not in b" \t\r\n"):
        raise MeshError(
            Code.NOT_PLY, f"Expected a file that begins with “ply”, found {shown(data[start : start + 12])}."
        )
    found = start
    while True:
        found = data.find(_END, found + 1, start + _LONGEST)
        if found < 0:
            raise MeshError(Code.TRUNCATED, "The file ends within its header: “end_header” is missing.")
        if data[found - 1 : found] in {b"\n", b"\r"}:
            break
    text = data[start:found].decode("utf-8", "replace")
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    return lines, _after_line(data, found + len(_END), text)


def _after_line(data: bytes, position: int, text: str) -> int:
    """Return the position after the line's end, written as the header's other lines end."""
    while data[position : position + 1] in {b" ", b"\t"}:
        position += 1
    if data[position : position + 2] == b"\r\n" and "\n" in text:
        return position + 2
    if data[position : position + 1] in {b"\n", b"\r"}:
        return position + 1
    if position >= len(data):
        return position
    raise MeshError(Code.BAD_HEADER, "Expected a line end after “end_header”.")


class _Builder:
    """Takes header lines one by one."""

    def __init__(self) -> None:
        self.format: str | None = None
        self.elements: dict[str, tuple[int, dict[str, Property]]] = {}  # rows, and properties by name
        self.texture_files: list[str] = []
        self.unknown: list[str] = []

    def take(self, line: str) -> None:
        words = line.split()
        match words[:1]:
            case [] | ["obj_info"]:
                return
            case ["comment"]:
                if words[1:2] == ["TextureFile"]:
                    self.texture_files.append(line.split("TextureFile", 1)[1].strip())
            case ["format"]:
                self._take_format(words)
            case ["element"]:
                self._take_element(words)
            case ["property"]:
                self._take_property(words)
            case _:
                self.unknown.append(line.strip())

    def _take_format(self, words: list[str]) -> None:
        if self.format is not None or len(words) != 3 or words[1] not in BYTE_ORDERS or words[2] != "1.0":
            raise _bad(f"expected one format (ascii or binary, 1.0), found {shown(' '.join(words))}")
        self.format = words[1]

    def _take_element(self, words: list[str]) -> None:
        if len(words) != 3 or not (words[2].isascii() and words[2].isdigit()) or len(words[2]) > 18:
            raise _bad(f"expected “element”, a name and a count, found {shown(' '.join(words))}")
        if words[1] in self.elements:
            raise _bad(f"the element {shown(words[1])} is declared twice")
        if not words[1].isprintable() or len(words[1]) > LONGEST_NAME:
            raise _bad(f"expected the name of an element, found {shown(words[1])}")
        self.elements[words[1]] = (int(words[2]), {})

    def _take_property(self, words: list[str]) -> None:
        if not self.elements:
            raise _bad("a property stands before the first element")
        field = _read_property(words)
        _, fields = self.elements[next(reversed(self.elements))]
        if field.name in fields:
            raise _bad(f"the property {shown(field.name)} is declared twice")
        fields[field.name] = field

    def finish(self, body: int) -> Header:
        if self.format is None:
            raise _bad("the line “format …” is missing")
        return Header(
            byte_order=BYTE_ORDERS[self.format],
            elements=tuple(
                Element(name=name, count=count, properties=tuple(fields.values()))
                for name, (count, fields) in self.elements.items()
                if fields  # rows without properties take no room
            ),
            texture_files=tuple(self.texture_files),
            body=body,
            warnings=tuple(among(self.unknown, "header lines are not understood and were skipped")),
        )


def _read_property(words: list[str]) -> Property:
    match words[1:]:
        case ["list", count, kind, name] if TYPES.get(count, "f")[0] != "f" and kind in TYPES:
            return Property(name=name, type=TYPES[kind], count_type=TYPES[count])
        case [kind, name] if kind in TYPES:
            return Property(name=name, type=TYPES[kind])
    raise _bad(f"expected a property with known types, found {shown(' '.join(words))}")


def _bad(what: str) -> MeshError:
    return MeshError(Code.BAD_HEADER, f"The PLY header cannot be right: {what}.")


def check_promise(header: Header, n_bytes: int, limits: Limits) -> None:
    """Refuse a header that promises nothing to see, or more than the file can hold.

    Parameters
    ----------
    header : Header
    n_bytes : int
        Size of the whole file.
    limits : Limits
        The most faces.

    Raises
    ------
    MeshError
        EMPTY, UNSUPPORTED, NO_FACES, BAD_HEADER, TRUNCATED, TOO_COMPLEX
    """
    counts = {element.name: element.count for element in header.elements}
    if counts.get("tristrips"):
        raise MeshError(Code.UNSUPPORTED, "Triangle strips are not read; save the mesh with faces.")
    if not counts.get("vertex") and not counts.get("face"):
        raise MeshError(Code.EMPTY, "The header announces neither vertices nor faces.")
    if not counts.get("face"):
        raise MeshError(Code.NO_FACES, "The file holds points only; expected faces.")
    _check_needed(header)
    text = header.byte_order == ""
    least = sum(element.count * element.least_bytes(text) for element in header.elements)
    left = n_bytes - header.body + int(text)  # the last line may end without a blank
    if least > left:
        raise MeshError(
            Code.TRUNCATED,
            f"The header announces at least {least:,} bytes of data, but only {max(left, 0):,} follow.",
        )
    if max(counts.values()) > limits.faces:
        raise MeshError(
            Code.TOO_COMPLEX,
            f"The header announces {max(counts.values()):,} rows; at most {limits.faces:,} are read.",
        )


def _check_needed(header: Header) -> None:
    """Refuse a header without what every mesh needs."""
    vertex, face = header.element("vertex"), header.element("face")
    names = {field.name for field in vertex.properties if field.count_type is None} if vertex else set()
    if not {"x", "y", "z"} <= names:
        raise MeshError(Code.BAD_HEADER, "The PLY header announces no vertices with x, y and z.")
    lists = {f.name: f.type for f in face.properties if f.count_type is not None} if face else {}
    kinds = [lists[name] for name in INDEX_NAMES if name in lists]
    if not kinds or kinds[0].startswith("f"):
        raise MeshError(Code.BAD_HEADER, "The PLY header announces no faces with a list “vertex_indices”.")
