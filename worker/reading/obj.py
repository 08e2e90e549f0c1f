"""OBJ files with their materials."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from worker.arrays import BoolArray, FloatArray, IntArray
from worker.errors import Code, MeshError
from worker.reading.contents import Material, Surface, check_finite, check_indices
from worker.reading.obj_lines import Block, is_obj, read_block
from worker.reading.obj_materials import find_materials
from worker.reading.references import SentFiles
from worker.reading.showing import shown
from worker.reading.words import blocks, with_line_feeds


@dataclass(frozen=True, kw_only=True, eq=False)
class _Faces:
    """The faces of all blocks, counted from 0."""

    vertices: IntArray  # (k,)
    uvs: IntArray  # (k,), 0 where there is none
    has_uvs: BoolArray  # (f,)
    counts: IntArray  # (f,), at least 3
    materials: IntArray  # (f,), index into names, or -1
    names: tuple[str, ...]
    dropped: int  # faces with fewer than three corners


def read_obj(data: bytes, name: str, files: SentFiles, *, allow_untextured: bool) -> Surface:
    """Read an OBJ file.

    Parameters
    ----------
    data : bytes
        The file.
    name : str
        Its path in the upload.
    files : SentFiles
        The upload, in which materials are looked up.
    allow_untextured : bool
        Go on without materials that were not sent.

    Raises
    ------
    MeshError
        Any code of a mesh file.
    """
    read = [read_block(text, line) for text, line in blocks(check_text(data))]
    _check_kind(read)
    vertices = np.concatenate([block.positions for block in read])
    uvs = np.concatenate([block.uvs for block in read])
    check_finite(vertices, "coordinates")
    check_finite(uvs, "texture coordinates")
    faces = _join_faces(read, len(vertices), len(uvs))
    libraries = [library for block in read for library in block.libraries]
    used = np.unique(faces.materials[faces.materials >= 0])
    found, warnings = find_materials(
        libraries, {faces.names[number] for number in used}, name, files, allow_untextured=allow_untextured
    )
    colours = _vertex_colours(np.concatenate([block.colours for block in read]), warnings)
    if faces.dropped:
        warnings.append(f"{faces.dropped} faces with fewer than three corners were dropped")
    return Surface(
        vertices=vertices,
        corners=faces.vertices,
        counts=faces.counts,
        corner_uvs=np.append(uvs, np.zeros((1, 2)), axis=0)[faces.uvs],
        face_has_uvs=faces.has_uvs,
        face_materials=faces.materials,
        materials=tuple(found.get(material, Material(name=material)) for material in faces.names),
        vertex_colours=colours,
        face_colours=None,
        warnings=tuple(warnings),
    )


def check_text(data: bytes) -> bytes:
    """Return the file's lines, each ended by a line feed, continued ones joined.

    Raises
    ------
    MeshError
        EMPTY, NOT_UTF8, NOT_OBJ, BAD_DATA
    """
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise MeshError(Code.NOT_UTF8, "The file is written in UTF-16; expected UTF-8 or ASCII.")
    text = with_line_feeds(data.removeprefix(b"\xef\xbb\xbf"))
    if not text or text.isspace():
        raise MeshError(Code.EMPTY, "The file is empty.")
    if b"\0" in text:
        if text.lstrip()[:2] in {b"v ", b"# ", b"o ", b"g ", b"mt", b"vt", b"vn"}:
            raise MeshError(Code.BAD_DATA, "The text holds zero bytes: it is damaged.")
        raise MeshError(Code.NOT_OBJ, f"Expected the text of an OBJ file, found {shown(text, 12)}.")
    return text.replace(b"\\\n", b" ")


def _check_kind(read: Sequence[Block]) -> None:
    """Refuse what holds no line of an OBJ file, no vertices or no faces."""
    keywords = frozenset[bytes]().union(*(block.keywords for block in read))
    if not is_obj(keywords) and not all(keyword.startswith(b"#") for keyword in keywords):
        raise MeshError(Code.NOT_OBJ, "Expected an OBJ file, but no line begins as its lines do.")
    if not any(len(block.positions) for block in read):
        raise MeshError(Code.EMPTY, "The file holds no vertices.")
    if not any(block.corners.counts.size for block in read):
        raise MeshError(Code.NO_FACES, "The file holds points or lines only; expected faces.")
    if not any((block.corners.counts >= 3).any() for block in read):
        raise MeshError(Code.BAD_DATA, "No face has three corners.")


def _join_faces(read: Sequence[Block], n_vertices: int, n_uvs: int) -> _Faces:
    counts = np.concatenate([block.corners.counts for block in read])
    kept = counts >= 3
    corner_kept = np.repeat(kept, counts)
    vertices, uvs, has_uv = _resolved_corners(read)
    check_indices(vertices, n_vertices)
    if not n_uvs:  # some programs number texture coordinates that they do not write
        has_uv = np.zeros_like(has_uv)
    check_indices(uvs[has_uv], n_uvs, "texture coordinate")
    materials, names = _materials(read)
    with_uv = np.add.reduceat(has_uv[corner_kept], np.cumsum(counts[kept]) - counts[kept], dtype=np.int64)
    return _Faces(
        vertices=vertices[corner_kept],
        uvs=np.where(has_uv, uvs, 0)[corner_kept],
        has_uvs=with_uv == counts[kept],
        counts=counts[kept],
        materials=materials[kept],
        names=names,
        dropped=int((~kept).sum()),
    )


def _resolved_corners(read: Sequence[Block]) -> tuple[IntArray, IntArray, BoolArray]:
    """Return indices from 0, relative ones resolved at their own line: vertices, uvs, has_uv, (k,) each."""
    vertices, uvs = [], []
    n_vertices = n_uvs = 0
    for block in read:
        corners = block.corners
        vertices.append(_from_zero(corners.vertices, n_vertices + block.vertices_before, corners.counts))
        uvs.append(_from_zero(corners.uvs, n_uvs + block.uvs_before, corners.counts))
        n_vertices += len(block.positions)
        n_uvs += len(block.uvs)
    has_uv = np.concatenate([block.corners.has_uv for block in read])
    return np.concatenate(vertices), np.concatenate(uvs), has_uv


def _from_zero(written: IntArray, before: IntArray, counts: IntArray) -> IntArray:
    """Count from 0: 1 is the first, -1 the last above its line; an invalid 0 becomes -1."""
    above = np.repeat(before, counts)
    found: IntArray = np.where(written < 0, above + written, written - 1)
    return found


def _materials(read: Iterable[Block]) -> tuple[IntArray, tuple[str, ...]]:
    """Return each face's material (f,), -1 before the first usemtl, and the names."""
    numbers: dict[str, int] = {}
    current = -1
    found = []
    for block in read:
        table = np.array([current, *(numbers.setdefault(name, len(numbers)) for name in block.materials)])
        found.append(table[block.material_of + 1])
        current = int(table[-1])
    return np.concatenate(found), tuple(numbers)


def _vertex_colours(colours: FloatArray, warnings: list[str]) -> FloatArray | None:
    """Return colours in 0…1 where all vertices have one (n, 3)."""
    whole = np.isfinite(colours).all(axis=1)
    if not whole.all():
        if whole.any():
            warnings.append(f"only {int(whole.sum())} of {whole.size} vertices have a colour; it was dropped")
        return None
    if colours.max() > 1 and (colours == np.floor(colours)).all() and colours.max() <= 255:
        warnings.append("vertex colours are whole numbers up to 255 and were divided by it")
        return np.clip(colours / 255.0, 0.0, 1.0)
    if colours.min() < 0 or colours.max() > 1:
        warnings.append("vertex colours outside of 0…1 were cut off")
    return np.clip(colours, 0.0, 1.0)
