"""What the headers of an upload's files tell, without reading the mesh itself."""

from collections.abc import Iterable

from worker.reading.assembling import find_texture
from worker.reading.contents import TextureMap
from worker.reading.limits import Limits
from worker.reading.obj import check_text
from worker.reading.obj_materials import find_materials
from worker.reading.obj_scan import named_libraries, used_materials
from worker.reading.ply import has_texture_coordinates, texture_maps
from worker.reading.ply_header import check_promise, read_header
from worker.reading.references import SentFiles
from worker.reading.textures import check_image


def inspect_files(files: SentFiles, name: str, limits: Limits, *, allow_untextured: bool) -> None:
    """Look at the header of a PLY file, or at the names in an OBJ file and the images that they mean.

    Parameters
    ----------
    files : SentFiles
        The upload.
    name : str
        The mesh's path in it.
    limits : Limits
    allow_untextured : bool
        Go on without materials and images that were not sent.

    Raises
    ------
    MeshError
        What `read_mesh` would raise, where that can be seen.
    """
    if name.lower().endswith(".ply"):
        inspect_ply(files, name, limits, allow_untextured=allow_untextured)
    else:
        _check_images(_obj_maps(files, name, allow_untextured), files, limits, allow_untextured)


def inspect_ply(files: SentFiles, name: str, limits: Limits, *, allow_untextured: bool) -> None:
    """Look at the header of a PLY file and at every image that it names; otherwise as `inspect_files`.

    Which of its images the faces use is told by the faces alone: all must be there.
    """
    header = read_header(files[name])
    check_promise(header, len(files[name]), limits)
    maps = texture_maps(header, name) if has_texture_coordinates(header) else []
    _check_images(maps, files, limits, allow_untextured)


def _check_images(
    maps: Iterable[TextureMap], files: SentFiles, limits: Limits, allow_untextured: bool
) -> None:
    found = [find_texture(texture, files, allow_untextured) for texture in maps]
    for image in dict.fromkeys(path for path in found if path is not None):
        check_image(files[image], image, limits)


def _obj_maps(files: SentFiles, name: str, allow_untextured: bool) -> list[TextureMap]:
    """Return the images that faces of an OBJ file need."""
    text = check_text(files[name])
    used = used_materials(text)
    materials, _ = find_materials(
        named_libraries(text), used.keys(), name, files, allow_untextured=allow_untextured
    )
    covered = (materials[material] for material, has_uvs in used.items() if has_uvs and material in materials)
    return list(dict.fromkeys(material.texture for material in covered if material.texture is not None))
