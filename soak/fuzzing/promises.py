"""What every outcome of reading must be: a refusal that a curator understands, or a sound mesh."""

import re
import unicodedata
from collections.abc import Iterable

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.describe import Description
from worker.errors import Code, MeshError
from worker.geometry.repair import Repaired
from worker.reading.mesh import Mesh

LONGEST = 500  # characters of a text for people
_QUOTED = re.compile("“[^”]*”")  # what the file itself says is not ours to judge
_TRACES = re.compile(
    r"Traceback|File \"|<\w+[ .].*>|\bobject at 0x|\bb['\"]|\b\w+(Error|Exception)\b|\bnp\.|dtype|\bNone\b"
)


class Broken(Exception):
    """A promise is broken; the text says which and how."""


def check_refusal(error: MeshError) -> None:
    """Expect a code of the list and a text for people."""
    if not isinstance(error.code, Code):
        raise Broken(f"the code {error.code!r} is none")
    check_texts([error.detail])


def check_texts(texts: Iterable[str]) -> None:
    """Expect words for people: not long, not empty, no control characters, nothing of Python's."""
    for text in texts:
        if not text.strip():
            raise Broken("a text is empty")
        if len(text) > LONGEST:
            raise Broken(f"a text has {len(text)} characters: {text[:80]!r}")
        odd = [character for character in text if unicodedata.category(character) in {"Cc", "Cs"}]
        if odd:
            raise Broken(f"a text holds control characters {odd[:3]!r}: {text[:80]!r}")
        trace = _TRACES.search(_QUOTED.sub("", text))
        if trace:
            raise Broken(f"a text shows the inside of the program, {trace.group()!r}: {text[:200]!r}")


def check_mesh(mesh: Mesh) -> None:
    """Expect finite numbers, colours in range, indices that name something."""
    _expect_finite(mesh.vertices, "vertices", columns=(3,))
    _expect_indices(mesh.faces, len(mesh.vertices), "faces")
    _expect_finite(mesh.corner_colours, "corner colours", columns=(3, 3))
    _expect_finite(mesh.corner_uvs, "texture coordinates", columns=(3, 2))
    n_faces = len(mesh.faces)
    if {len(mesh.corner_colours), len(mesh.corner_uvs), len(mesh.face_textures)} != {n_faces}:
        raise Broken("the arrays of the faces have several lengths")
    if n_faces and not (mesh.corner_colours.min() >= 0 and mesh.corner_colours.max() <= 1):
        raise Broken("corner colours leave 0…1")
    if n_faces and not (mesh.face_textures.min() >= -1 and mesh.face_textures.max() < len(mesh.textures)):
        raise Broken("a face names a texture that is not there")
    for texture in mesh.textures:
        if texture.dtype != np.uint8 or texture.ndim != 3 or texture.shape[2] != 3 or not texture.size:
            raise Broken(f"a texture is {texture.dtype} of shape {texture.shape}")
    check_texts(mesh.warnings)


def check_repaired(repaired: Repaired, mesh: Mesh) -> None:
    """Expect at least one face with an area, and faces that know where they come from."""
    _expect_finite(repaired.vertices, "repaired vertices", columns=(3,))
    _expect_indices(repaired.faces, len(repaired.vertices), "repaired faces")
    if not len(repaired.faces):
        raise Broken("no face is left, and nobody said so")
    if repaired.source_faces.min() < 0 or repaired.source_faces.max() >= len(mesh.faces):
        raise Broken("a repaired face comes from nowhere")
    if repaired.components < 1:
        raise Broken(f"{repaired.components} components")
    check_texts(repaired.warnings)


def check_description(description: Description) -> None:
    """Expect finite numbers in every block and signature, and pictures."""
    for name, array in {**description.blocks, **description.signatures}.items():
        if not np.isfinite(array).all():
            raise Broken(f"“{name}” holds numbers that are not finite")
    if not np.isfinite(description.facts.area) or description.facts.area <= 0:
        raise Broken(f"the area is {description.facts.area}")
    if not description.thumbnail.startswith(b"\x89PNG") or not description.preview.startswith(b"glTF"):
        raise Broken("a picture is missing")
    check_texts(description.facts.warnings)


def _expect_finite(array: FloatArray, what: str, columns: tuple[int, ...]) -> None:
    if array.shape[1:] != columns or array.dtype != np.float64:
        raise Broken(f"{what} are {array.dtype} of shape {array.shape}")
    if not np.isfinite(array).all():
        raise Broken(f"{what} are not finite")


def _expect_indices(array: IntArray, most: int, what: str) -> None:
    if array.shape[1:] != (3,) or array.dtype.kind != "i":
        raise Broken(f"{what} are {array.dtype} of shape {array.shape}")
    if array.size and not (array.min() >= 0 and array.max() < most):
        raise Broken(f"{what} name vertices from {array.min()} to {array.max()}, of {most}")
