"""Materials of OBJ files (.mtl): the diffuse colour and its image."""

import re
from collections.abc import Iterator

from worker.errors import Code, MeshError
from worker.reading.contents import Material, TextureMap
from worker.reading.showing import shown

# Options that may stand before or after the name of an image, and the most arguments each takes.
_OPTIONS = {
    "-blendu": 1,
    "-blendv": 1,
    "-boost": 1,
    "-bm": 1,
    "-cc": 1,
    "-clamp": 1,
    "-colorspace": 1,
    "-imfchan": 1,
    "-mm": 2,
    "-o": 3,
    "-s": 3,
    "-t": 3,
    "-texres": 1,
    "-type": 1,
}
_NUMBER = re.compile(r"(?=.{1,40}$)[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$")
_MOST = 1e6  # of a scale or an offset; more shows nothing but noise
_OPTIONAL = {"-mm", "-o", "-s", "-t"}  # their second and third number may be left out


def decode_text(data: bytes) -> str:
    """Return text as UTF-8, or as Latin-1 where it is not: only names can differ."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def read_mtl(data: bytes, name: str) -> dict[str, Material]:
    """Read the materials of one file.

    Parameters
    ----------
    data : bytes
        The file.
    name : str
        Its path in the upload.

    Returns
    -------
    dict[str, Material]
        By name; a material without a name cannot be told from others and is left out.

    Raises
    ------
    MeshError
        BAD_NUMBER where a colour is none, NOT_UTF8 for UTF-16.
    """
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise MeshError(Code.NOT_UTF8, f"{shown(name)} is written in UTF-16; expected UTF-8.")
    materials: dict[str, Material] = {}
    for material, lines in _sections(decode_text(data)):
        materials.setdefault(material, _read_material(material, lines, name))
    materials.pop("", None)
    return materials


def _sections(text: str) -> Iterator[tuple[str, list[tuple[str, str]]]]:
    """Yield each material's name with its (keyword, rest) lines."""
    name, lines = "", list[tuple[str, str]]()
    for line in re.split(r"[\r\n]+", text):
        keyword, _, rest = line.strip().replace("\t", " ").partition(" ")
        if keyword.lower() == "newmtl":
            yield name, lines
            name, lines = rest.strip(), []
        elif keyword.lower() in {"kd", "map_kd"}:
            lines.append((keyword.lower(), rest.strip()))
    yield name, lines


def _read_material(material: str, lines: list[tuple[str, str]], name: str) -> Material:
    colour, texture = None, None
    for keyword, rest in lines:
        if keyword == "kd":
            colour = _read_colour(rest, name)
        elif rest:
            texture = read_map(rest, name)
    return Material(name=material, colour=colour, texture=texture)


def _read_colour(rest: str, name: str) -> tuple[float, float, float] | None:
    words = rest.partition("#")[0].split()
    if not words or words[0].lower() in {"xyz", "spectral"}:
        return None  # colours by spectrum curves: no program writes them
    if not all(_NUMBER.match(word) for word in words):
        raise MeshError(
            Code.BAD_NUMBER, f"{shown(name)}: expected Kd and three numbers, found {shown(rest, 40)}."
        )
    numbers = [min(max(float(word), 0.0), 1.0) for word in words[:3]]
    red, green, blue = numbers if len(numbers) == 3 else numbers[:1] * 3
    return red, green, blue


def read_map(rest: str, name: str) -> TextureMap | None:
    """Read what stands after ``map_Kd``: options, then a file name that may hold blanks.

    Returns
    -------
    TextureMap | None
        None where no file is named.
    """
    options: dict[str, list[str]] = {}
    words = list(re.finditer(r"\S+", rest))
    first = _take_options(words, options)
    last = next(
        (place for place in range(first + 1, len(words)) if words[place].group().lower() in _OPTIONS),
        len(words),
    )
    file = rest[words[first].start() : words[last - 1].end()].strip('"') if first < last else ""
    if not file:
        return None
    return TextureMap(
        reference=file,
        named_by=name,
        scale=_pair(options.get("-s"), 1.0),
        offset=_pair(options.get("-o"), 0.0),
    )


def _take_options(words: list[re.Match[str]], options: dict[str, list[str]]) -> int:
    """Collect leading options; return the place of the first word of the file name."""
    place = 0
    while place < len(words) - 1 and words[place].group().lower() in _OPTIONS:
        option = words[place].group().lower()
        place += 1
        taken: list[str] = []
        while len(taken) < _OPTIONS[option] and place < len(words) - 1:
            word = words[place].group()
            if option in _OPTIONAL and not _NUMBER.match(word):
                break
            taken.append(word)
            place += 1
        options[option] = taken
    return place


def _pair(words: list[str] | None, default: float) -> tuple[float, float]:
    numbers = [min(max(float(word), -_MOST), _MOST) for word in words or []][:2]
    u, v = numbers + [default] * (2 - len(numbers))
    return u, v
