"""PLY files, strictly by their own header: text and binary, either byte order, any properties."""

from collections.abc import Sequence

import numpy as np

from worker.arrays import BoolArray, FloatArray, IntArray
from worker.errors import Code, MeshError
from worker.reading.contents import Material, Surface, TextureMap, check_finite, check_indices
from worker.reading.limits import Limits
from worker.reading.ply_ascii import read_ascii
from worker.reading.ply_binary import read_binary
from worker.reading.ply_columns import Body, Lists, Table
from worker.reading.ply_header import INDEX_NAMES, Header, check_promise, read_header

_COLOUR_NAMES = (
    ("red", "green", "blue"),
    ("diffuse_red", "diffuse_green", "diffuse_blue"),
    ("r", "g", "b"),
)
_UV_NAMES = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"), ("texture_s", "texture_t"))


def read_ply(data: bytes, name: str, limits: Limits) -> Surface:
    """Read a PLY file.

    Parameters
    ----------
    data : bytes
        The file.
    name : str
        Its path in the upload.
    limits : Limits
        The most faces.

    Raises
    ------
    MeshError
        Any code of a mesh file.
    """
    header = read_header(data)
    check_promise(header, len(data), limits)
    body = read_binary(data, header) if header.byte_order else read_ascii(data, header)
    vertices = np.stack([body["vertex"].scalars[axis] for axis in "xyz"], axis=1)  # (n, 3)
    lists = body["face"].lists
    indices = next(lists[known] for known in INDEX_NAMES if known in lists)
    check_indices(indices.values.astype(np.int64), len(vertices))
    check_finite(vertices, "coordinates")
    return _surface(header, body, vertices, indices, name)


def texture_maps(header: Header, name: str) -> list[TextureMap]:
    """Return the images that a file's comments name; `name` is its path in the upload."""
    return [TextureMap(reference=file, named_by=name) for file in header.texture_files]


def has_texture_coordinates(header: Header) -> bool:
    """Return whether the header announces texture coordinates, of vertices or of corners."""
    vertex, face = header.element("vertex"), header.element("face")
    names = {field.name for field in vertex.properties} if vertex else set()
    lists = {field.name for field in face.properties if field.count_type} if face else set()
    return "texcoord" in lists or any(names >= set(pair) for pair in _UV_NAMES)


def _surface(header: Header, body: Body, vertices: FloatArray, indices: Lists, name: str) -> Surface:
    warnings = [*header.warnings]
    kept = indices.counts >= 3
    if not kept.all():
        warnings.append(f"{int((~kept).sum()):,} faces with fewer than three corners were dropped")
    corner_kept = np.repeat(kept, indices.counts)
    uvs, has_uvs = _texture_coordinates(body, indices)
    chosen = _chosen_materials(body["face"], len(header.texture_files), kept.size)
    face_colours = _colours(header, body, "face", warnings)
    return Surface(
        vertices=vertices,
        corners=indices.values[corner_kept].astype(np.int64),
        counts=indices.counts[kept],
        corner_uvs=uvs[corner_kept],
        face_has_uvs=has_uvs[kept],
        face_materials=chosen[kept],
        materials=tuple(
            Material(name=texture.reference, texture=texture) for texture in texture_maps(header, name)
        ),
        vertex_colours=_colours(header, body, "vertex", warnings),
        face_colours=None if face_colours is None else face_colours[kept],
        warnings=tuple(warnings),
    )


def _first_names(names: Sequence[Sequence[str]], table: Table) -> Sequence[str] | None:
    return next((found for found in names if all(name in table.scalars for name in found)), None)


def _colours(header: Header, body: Body, element: str, warnings: list[str]) -> FloatArray | None:
    """Return colours in 0…1 by the declared type: whole numbers by its maximum, floats as they are."""
    scalars = body[element].scalars
    names = _first_names(_COLOUR_NAMES, body[element])
    declared = header.element(element)
    if names is None or declared is None:
        return None
    types = {field.name: field.type for field in declared.properties}
    most = [1.0 if types[name][0] == "f" else float(np.iinfo(types[name]).max) for name in names]
    colours = np.stack([scalars[name] for name in names], axis=1) / most  # (n, 3)
    if not np.isfinite(colours).all():
        warnings.append(f"some {element} colours are no finite numbers; the {element} colours were dropped")
        return None
    if colours.size and (colours.min() < 0 or colours.max() > 1):
        warnings.append(f"{element} colours outside of 0…1 were cut off")
    return np.clip(colours, 0.0, 1.0)


def _texture_coordinates(body: Body, indices: Lists) -> tuple[FloatArray, BoolArray]:
    """Return texture coordinates of all corners (k, 2), and which faces (f,) have them."""
    corners = indices.values.astype(np.int64)
    if "texcoord" in body["face"].lists:
        return _listed_coordinates(body["face"].lists["texcoord"], indices.counts)
    names = _first_names(_UV_NAMES, body["vertex"])
    if names is None:
        return np.zeros((corners.size, 2)), np.zeros(indices.counts.size, dtype=np.bool_)
    uvs = np.stack([body["vertex"].scalars[name] for name in names], axis=1)  # (n, 2)
    check_finite(uvs, "texture coordinates")
    return uvs[corners], np.ones(indices.counts.size, dtype=np.bool_)


def _listed_coordinates(listed: Lists, counts: IntArray) -> tuple[FloatArray, BoolArray]:
    """Return the texture coordinates that the faces list: u and v of each corner, or nothing."""
    filled = listed.counts > 0
    wrong = filled & (listed.counts != 2 * counts)
    if wrong.any():
        row = int(np.argmax(wrong))
        raise MeshError(
            Code.BAD_DATA,
            f"The face number {row + 1} has {int(counts[row])} corners but {int(listed.counts[row])} "
            "texture coordinates; expected two for each corner.",
        )
    uvs = np.zeros((int(counts.sum()), 2))
    uvs[np.repeat(filled, counts)] = listed.values.reshape(-1, 2)
    check_finite(uvs, "texture coordinates")
    return uvs, filled


def _chosen_materials(face: Table, n_materials: int, n_faces: int) -> IntArray:
    """Return each face's texture (f,): its texnumber, or the first."""
    if not n_materials:
        return np.full(n_faces, -1, dtype=np.int64)
    numbers = face.scalars.get("texnumber", np.zeros(n_faces))
    valid = (numbers >= 0) & (numbers < n_materials)
    return np.where(valid, numbers, -1).astype(np.int64)
