"""A side of an explanation: one of two shapes, with what its numbers are made of at each point."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from index.errors import BadBlock, FileMissing, VocabularyChanged
from index.packing import rounded
from index.vocabulary import Vocabulary
from service.library import Library
from service.remembered_words import in_active_words, remembered_signatures
from service.remembering import QueryNotFound, query_key, recall
from service.storage import PREVIEW, derived_key, load_signatures
from service.why.errors import NotExplained
from worker.arrays import FloatArray, IntArray, SingleArray
from worker.descriptors.curves import colour_curves
from worker.descriptors.orders import curve_orders
from worker.geometry.colour import srgb_to_lab
from worker.parameters import Parameters
from worker.pictures.preview_points import NoPreview, read_colours, read_points
from worker.solving import areas_of

SAME = 1e-3  # share of the area by which a preview may differ from the surface whose signatures are kept


@dataclass(frozen=True, kw_only=True, eq=False)
class Side:
    """One of two shapes."""

    blocks: Mapping[str, SingleArray]  # as an index compares them
    signatures: Mapping[str, SingleArray]  # one row a vertex, those of a `Description`
    vertices: FloatArray  # (n, 3), of the canonical surface
    faces: IntArray  # (m, 3)
    lab: FloatArray  # (n, 3), CIE Lab of the vertices
    parameters: Parameters  # of the signatures

    @cached_property
    def shares(self) -> FloatArray:
        """The vertices' shares of the area, (n,)."""
        areas = self.signature("areas")
        return np.asarray(areas / areas.sum())

    @cached_property
    def orders(self) -> FloatArray:
        """What the colour curves are ordered by, (n, t)."""
        return curve_orders(self.signature("hks-0"), self.signature("log-hks"), self.parameters)

    @cached_property
    def curves(self) -> FloatArray:
        """The colour curves (t, b, 3), not whitened."""
        return colour_curves(self.orders, self.lab, self.shares, self.parameters.curve_bins)

    def signature(self, name: str) -> FloatArray:
        """Return a signature; BadBlock where an earlier version has left none."""
        if name not in self.signatures:
            raise BadBlock(f"the shape has no signature {name!r}; index its files anew")
        return np.asarray(self.signatures[name], np.float64)


def stored_side(library: Library, shape_id: str, names: Collection[str], vocabulary: Vocabulary) -> Side:
    """Return the side of a stored shape.

    Parameters
    ----------
    names : collection of str
        Of the blocks that are compared.
    vocabulary : Vocabulary
        The active one.

    Raises
    ------
    ShapeNotFound, NotReady, FileMissing, BadBlock, VocabularyChanged, NotExplained
    """
    stored = library.catalogue.query_blocks(shape_id, names)
    _check_words(stored.vocabulary_id, vocabulary)
    signatures = load_signatures(library.files, shape_id, stored.made_in)
    preview = library.files.get(derived_key(shape_id, PREVIEW, stored.made_in))
    return side_of(stored.blocks, signatures, preview, names, library.parameters)


def remembered_side(library: Library, query_id: str, names: Collection[str], vocabulary: Vocabulary) -> Side:
    """Return the side of a remembered query; arguments as for `stored_side`.

    Raises
    ------
    QueryNotFound, BadBlock, VocabularyChanged, NotExplained
    """
    vocabulary_id, blocks = in_active_words(library, recall(library, query_id))
    _check_words(vocabulary_id, vocabulary)
    signatures = remembered_signatures(library, query_id)
    try:
        preview = library.files.get(query_key(query_id, PREVIEW))
    except FileMissing:  # removed in this moment
        raise QueryNotFound("this query is not remembered any more; send its mesh again") from None
    return side_of(blocks, signatures, preview, names, library.parameters)


def side_of(
    blocks: Mapping[str, SingleArray],
    signatures: Mapping[str, SingleArray],
    preview: bytes,
    names: Collection[str],
    parameters: Parameters,
) -> Side:
    """Return a side of what is known of a shape, stored or not.

    A preview holds the vertices that the signatures belong to, in the same order, unless these were too many
    for it.

    Raises
    ------
    BadBlock
        A block is missing.
    NotExplained
        The preview cannot be read, or is not of the surface whose signatures these are.
    """
    missing = [name for name in names if name not in blocks]
    if missing:
        raise BadBlock(f"the shape has no block {missing[0]!r}; index its files anew")
    try:
        vertices, faces = read_points(preview)
        lab = srgb_to_lab(read_colours(preview))
    except NoPreview as error:
        raise NotExplained("this shape's preview cannot be read; index its files anew") from error
    side = Side(
        blocks={name: rounded(name, blocks[name]) for name in names},
        signatures=signatures,
        vertices=vertices,
        faces=faces,
        lab=lab,
        parameters=parameters,
    )
    _check_same(side)
    return side


def rehearse() -> None:
    """Load the compiled functions of this file; on a machine's first start they are compiled."""
    srgb_to_lab(np.eye(3))
    areas_of(np.eye(3), np.array([[0, 1, 2]]))


def _check_words(vocabulary_id: str | None, vocabulary: Vocabulary) -> None:
    """Refuse blocks in the words of another vocabulary than that which their places are looked up with."""
    if vocabulary_id != vocabulary.id:
        raise VocabularyChanged("another vocabulary became active in this moment; try again")


def _check_same(side: Side) -> None:
    """Refuse a preview whose vertices are not those that the signatures belong to."""
    kept, shown = side.signature("areas"), areas_of(side.vertices, side.faces)
    if len(kept) != len(shown) or np.abs(kept - shown).sum() > SAME * kept.sum():
        raise NotExplained(
            "this shape consists of so many small pieces that only a coarser preview of it is kept, on which "
            "differences cannot be shown"
        )
