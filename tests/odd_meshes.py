"""The tables of odd and broken meshes: what each is sent as, and what must become of it."""

import csv
import posixpath
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from tests.conftest import SHARED

ODD = SHARED / "odd-meshes"
FLAT = "flat and small surfaces are no fault: polygons are accepted, and REAL.tsv accepts single triangles"
NO_MTL = "a face uses a material whose MTL was not sent: missing_texture, whatever the number of faces"

# Rows that the design (section 4) contradicts: what comes instead, and why.
JUDGED_WRONG = {
    "ply_ngon1000_ascii.ply": ("none", FLAT),
    "geo_ngon1000.obj": ("none", FLAT),
    "geo_2_triangles.obj": ("none", FLAT),
    "box_UTF16BE.obj": ("not_utf8", "MADE.tsv refuses UTF-16, for which there is a code of its own"),
    "number_formats.obj": ("bad_number", "“3.1+e2” is no number; that the face has no area comes later"),
    "spider.obj": ("texture", "its images were sent: “.\\” and backslashes are no reason to miss them"),
    "cube_mtllib_after_g.obj": ("missing_texture", NO_MTL),
    "cube_mtllib_missing.obj": ("missing_texture", NO_MTL),
    "jacked.obj": ("missing_texture", NO_MTL),
    "notenoughindices.obj": ("missing_texture", NO_MTL),
    "polygonfaces.obj": ("missing_texture", NO_MTL),
    "singlevn.obj": ("missing_texture", NO_MTL),
    "issue-244-mtl-searchpaths.obj": ("missing_texture", NO_MTL),
}
# Codes of the tables that are broader than those of the program.
BROADER = {
    "malformed": frozenset({"truncated", "bad_header", "bad_data"}),
    "not_a_mesh": frozenset({"not_ply", "not_obj"}),
}
COLOURS = {  # what a row says of the colour, where it does
    "ok:vertex_colors": "vertex",
    "ok:vertex_colors(constant)": "vertex",
    "ok:vertex": "vertex",
    "ok:face": "face",
    "ok:texture": "texture",
    "ok:material_colour": "material",
    "ok:material-only": "material",
    "ok:no_colour": "none",
    "ok:none": "none",
}


@dataclass(frozen=True, kw_only=True)
class OddMesh:
    """One row of a table, after the corrections above."""

    table: str  # its file
    entry: str  # the mesh's path, from the table's folder
    accepted: bool
    codes: frozenset[str]  # with which it may be refused; empty where it is accepted
    colour: str | None  # that is found, where the row says

    @property
    def name(self) -> str:
        """The mesh file's own name."""
        return Path(self.entry).name

    @cached_property
    def files(self) -> dict[str, bytes]:
        """What is sent: relative name → content."""
        return made(self.entry) if self.table == "MADE.tsv" else real(self.entry)


def odd_meshes(*tables: str) -> list[OddMesh]:
    """Return the rows of these tables; none where the meshes are not here."""
    return [_judged(table, row) for table in tables for row in _rows(table)]


def made(entry: str) -> dict[str, bytes]:
    """Return a file alone, or all files of the folder that a mesh has for itself."""
    path = ODD / "made" / entry
    if "/" not in entry:
        return {path.name: path.read_bytes()}
    return {file.name: file.read_bytes() for file in path.parent.iterdir()}


def real(entry: str) -> dict[str, bytes]:
    """Return a mesh with what it names inside its repository's folder."""
    root = ODD / "real" / entry.split("/")[0]
    names, left = set[str](), [entry.split("/", 1)[1]]
    while left:
        name = left.pop()
        if name not in names and (root / name).is_file():
            names.add(name)
            if not name.lower().endswith((".png", ".jpg")):
                left += [
                    posixpath.normpath(posixpath.join(posixpath.dirname(name), other))
                    for other in _named(root / name)
                ]
    return {name: (root / name).read_bytes() for name in names}


def _rows(table: str) -> list[dict[str, str]]:
    path = ODD / table
    if not path.is_file():
        return []
    with path.open(encoding="utf-8") as lines:
        return list(csv.DictReader(lines, delimiter="\t", quoting=csv.QUOTE_NONE))


def _judged(table: str, row: dict[str, str]) -> OddMesh:
    entry = row["entry"] if table == "MADE.tsv" else row["path"]
    accepted, code, colour = row["expected"] == "accept", row["code"], COLOURS.get(row["code"])
    if (name := Path(entry).name) in JUDGED_WRONG:
        code, _ = JUDGED_WRONG[name]
        accepted = code in COLOURS.values()
        colour = code if accepted else None
    codes = frozenset() if accepted else BROADER.get(code, frozenset({code}))
    return OddMesh(table=table, entry=entry, accepted=accepted, codes=codes, colour=colour)


def _named(path: Path) -> Iterator[str]:
    """Yield what may be file names in a mesh or a material file."""
    for line in path.read_bytes().decode("latin-1").splitlines():
        match = re.match(r"\s*(?:mtllib|map_Kd|comment\s+TextureFile)\s+(.*\S)", line)
        if match:
            whole = match[1].replace("\\ ", " ").replace("\\", "/")
            yield from (whole, *whole.split(), *re.split(r"(?<=\.mtl)\s+", whole))
