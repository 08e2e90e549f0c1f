"""A side of a comparison: what is known of one shape when its relation to another is looked for."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property, partial

import numpy as np

from index.errors import FileMissing
from index.packing import rounded
from index.shapes import Shape
from service.library import Library
from service.relations.postures import posture_of
from service.remembering import Remembered, query_key
from service.storage import PREVIEW, derived_key
from worker.arrays import SingleArray
from worker.describe import Description
from worker.descriptors.alignment import Placed
from worker.pictures.preview_points import NoPreview, read_points

WORDS, HISTOGRAM, CURVES = "log-hks", "colour-histogram", "colour-curves"
NAMES = (WORDS, HISTOGRAM, CURVES)  # blocks of a side
MESHES = (".ply", ".obj", ".zip")  # files that hold a surface


@dataclass(frozen=True, kw_only=True, eq=False)
class Side:
    """One of two shapes; what costs something is read when it is asked for."""

    blocks: Mapping[str, SingleArray]  # NAMES, as an index compares them
    area: float  # in the file's own squared unit
    mesh_files: frozenset[str]  # SHA-256 of what holds its surface
    preview: Callable[[], bytes | None]  # None where there is none
    posture: Callable[[], SingleArray | None]  # None where the preview is not there, or cannot be read

    @cached_property
    def placed(self) -> Placed | None:
        """The surface where it is, from the preview."""
        glb = self.preview()
        try:
            return None if glb is None else Placed(*read_points(glb))
        except NoPreview:
            return None


def described_side(
    description: Description, blocks: Mapping[str, SingleArray], files: Iterable[tuple[str, str]]
) -> Side:
    """Return the side of a mesh that is not kept.

    Parameters
    ----------
    description : Description
    blocks : mapping of str to array
        Its blocks in the words of the active vocabulary.
    files : iterable of (name, SHA-256)
    """
    return Side(
        blocks={name: rounded(name, blocks[name]) for name in NAMES if name in blocks},
        area=description.facts.area,
        mesh_files=_meshes(files),
        preview=lambda: description.preview,
        posture=partial(posture_of, description.preview),
    )


def remembered_side(library: Library, query: Remembered, blocks: Mapping[str, SingleArray]) -> Side:
    """Return the side of a remembered query; as `described_side`."""
    glb = cache(partial(_kept, library, query_key(query.id, PREVIEW)))
    return Side(
        blocks={name: rounded(name, blocks[name]) for name in NAMES if name in blocks},
        area=query.facts.area,
        mesh_files=_meshes(query.files),
        preview=glb,
        posture=lambda: posture_of(found) if (found := glb()) is not None else None,
    )


def stored_sides(library: Library, shape_ids: Sequence[str], vocabulary_id: str) -> dict[str, Side]:
    """Return the sides of stored shapes by id; those that are not ready, or just removed, drop out."""
    blocks = library.catalogue.some_blocks(shape_ids, vocabulary_id, NAMES)
    shapes = library.catalogue.get_many(shape_ids)
    return {
        shape_id: _stored_side(library, shapes[shape_id], blocks[shape_id])
        for shape_id in shape_ids
        if shape_id in shapes and set(NAMES) <= blocks[shape_id].keys()
    }


def apart(one: Side, other: Side, name: str) -> float:
    """Return the L1 distance of a block."""
    return float(np.abs(one.blocks[name] - other.blocks[name]).sum(dtype=np.float64))


def _stored_side(library: Library, shape: Shape, blocks: Mapping[str, SingleArray]) -> Side:
    return Side(
        blocks=blocks,
        area=float((shape.facts or {}).get("area", 0.0)),
        mesh_files=_meshes((file.name, file.sha256) for file in shape.files),
        preview=partial(_kept, library, derived_key(shape.id, PREVIEW, shape.made_in)),
        posture=partial(library.postures.of, library.files, shape.id, shape.revision, shape.made_in),
    )


def _kept(library: Library, key: str) -> bytes | None:
    try:
        return library.files.get(key)
    except FileMissing:  # removed in this moment
        return None


def _meshes(files: Iterable[tuple[str, str]]) -> frozenset[str]:
    return frozenset(sha256 for name, sha256 in files if name.lower().endswith(MESHES))
