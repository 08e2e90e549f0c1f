"""A surface and the files sent with it become a mesh: polygons split, textures opened, colours laid."""

from dataclasses import dataclass

import numpy as np

from worker.arrays import BoolArray, ByteArray, FloatArray, IntArray
from worker.errors import Code, MeshError
from worker.reading.contents import Material, Surface, TextureMap, among
from worker.reading.limits import Limits
from worker.reading.mesh import Colour, Mesh
from worker.reading.polygons import triangulate
from worker.reading.references import SentFiles
from worker.reading.showing import shown
from worker.reading.textures import read_image

NO_COLOUR = 0.5  # the grey of faces that have no colour


@dataclass(frozen=True, kw_only=True, eq=False)
class _Textures:
    """The images of a surface's materials."""

    images: tuple[ByteArray, ...]
    of_material: IntArray  # (n_materials,), index into images, or -1
    warnings: tuple[str, ...]


def assemble(surface: Surface, files: SentFiles, *, allow_untextured: bool, limits: Limits) -> Mesh:
    """Split the polygons and give every triangle the richest colour that the file has for it.

    An image comes before vertex colours, these before face colours, these before the colour of a material.

    Raises
    ------
    MeshError
        TOO_COMPLEX, MISSING_TEXTURE, UNSAFE_REFERENCE, BAD_IMAGE, IMAGE_TOO_LARGE
    """
    check_size(int(surface.counts.sum()) - 2 * surface.counts.size, limits)
    triangles, sources = triangulate(surface.vertices, surface.corners, surface.counts)
    textures = _open_textures(surface, files, allow_untextured, limits)
    materials = surface.face_materials[sources]  # (m,)
    textured = np.append(textures.of_material, -1)[materials]  # a material of -1 has texture -1
    textured = np.where(surface.face_has_uvs[sources], textured, -1)
    colours, colour = _colours(surface, triangles, sources)
    return Mesh(
        vertices=surface.vertices,
        faces=surface.corners[triangles],
        corner_colours=colours,
        corner_uvs=_place(surface.corner_uvs[triangles], materials, surface.materials),
        face_textures=textured,
        textures=textures.images,
        colour=_richest(colour, textured),
        warnings=(*surface.warnings, *textures.warnings, *_ignored(surface, textured)),
    )


def check_size(n_triangles: int, limits: Limits) -> None:
    """Refuse more triangles than the limit.

    Raises
    ------
    MeshError
        TOO_COMPLEX
    """
    if n_triangles > limits.faces:
        raise MeshError(
            Code.TOO_COMPLEX, f"The mesh has {n_triangles:,} triangles; at most {limits.faces:,} are read."
        )


def needed_maps(surface: Surface) -> dict[int, TextureMap]:
    """Return the images that are needed, by material: those laid over a face with texture coordinates."""
    used = np.unique(surface.face_materials[surface.face_has_uvs])
    found = {int(material): surface.materials[material].texture for material in used if material >= 0}
    return {material: texture for material, texture in found.items() if texture is not None}


def _open_textures(surface: Surface, files: SentFiles, allow_untextured: bool, limits: Limits) -> _Textures:
    places: dict[str, int] = {}  # each image is opened once, however many materials name it
    of_material = np.full(len(surface.materials), -1, dtype=np.int64)
    missing: dict[str, None] = {}
    for material, texture in needed_maps(surface).items():
        name = find_texture(texture, files, allow_untextured)
        if name is None:
            missing[texture.reference] = None
        else:
            of_material[material] = places.setdefault(name, len(places))
    images = tuple(read_image(files[name], name, limits) for name in places)
    warnings = tuple(among(list(missing), "images were not sent; their faces have no texture"))
    return _Textures(images=images, of_material=of_material, warnings=warnings)


def find_texture(texture: TextureMap, files: SentFiles, allow_untextured: bool) -> str | None:
    """Find the file of an image.

    Returns
    -------
    str | None
        Its path in the upload; None where it was not sent and that is allowed.

    Raises
    ------
    MeshError
        MISSING_TEXTURE, UNSAFE_REFERENCE
    """
    try:
        found = files.find(texture.reference, texture.named_by)
    except MeshError:
        if allow_untextured:
            return None
        raise
    if found is None and not allow_untextured:
        raise MeshError(
            Code.MISSING_TEXTURE,
            f"{shown(texture.named_by)} names the image {shown(texture.reference)}, which was not sent; "
            "send it with the mesh, or allow the mesh without its texture.",
        )
    return found


def _colours(surface: Surface, triangles: IntArray, sources: IntArray) -> tuple[FloatArray, Colour]:
    """Return the colours without textures (m, 3, 3), and where the richest came from."""
    if surface.vertex_colours is not None:
        return surface.vertex_colours[surface.corners[triangles]], Colour.VERTEX
    if surface.face_colours is not None:
        return np.repeat(surface.face_colours[sources][:, None], 3, axis=1), Colour.FACE
    grey = (NO_COLOUR,) * 3
    table = np.array(
        [*(material.colour or grey for material in surface.materials), grey]
    )  # (n_materials+1, 3)
    materials = surface.face_materials[sources]
    has_colour = np.array([*(material.colour is not None for material in surface.materials), False])
    colour = Colour.MATERIAL if has_colour[materials].any() else Colour.NONE
    return np.repeat(table[materials][:, None], 3, axis=1), colour


def _place(uvs: FloatArray, materials: IntArray, listed: tuple[Material, ...]) -> FloatArray:
    """Scale and move texture coordinates (m, 3, 2) as the materials of the faces (m,) say."""
    maps = [material.texture or TextureMap(reference="", named_by="") for material in listed]
    if all(texture.scale == (1.0, 1.0) and texture.offset == (0.0, 0.0) for texture in maps):
        return uvs
    scales = np.array([*(texture.scale for texture in maps), (1.0, 1.0)])
    offsets = np.array([*(texture.offset for texture in maps), (0.0, 0.0)])
    placed: FloatArray = uvs * scales[materials][:, None] + offsets[materials][:, None]
    return placed


def _richest(colour: Colour, textured: IntArray) -> Colour:
    return Colour.TEXTURE if (textured >= 0).any() else colour


def _ignored(surface: Surface, textured: IntArray) -> list[str]:
    """Say which colours gave way to the texture."""
    covered: BoolArray = textured >= 0
    if not covered.any():
        return []
    sources = (("vertex", surface.vertex_colours), ("face", surface.face_colours))
    return [f"{name} colours give way to the texture" for name, found in sources if found is not None]
