"""The numbers of one shape, for those who want to look at them."""

from collections.abc import Mapping
from dataclasses import dataclass

from index.errors import NotReady
from index.shapes import Status
from service.library import Library
from service.storage import load_signatures
from service.vocabularies import vocabulary_for
from worker.arrays import SingleArray

EIGENVALUES = "eigenvalues-"  # names of signatures that hold a spectrum, before η


@dataclass(frozen=True, kw_only=True, eq=False)
class Numbers:
    """What a shape is compared by."""

    vocabulary_id: str  # of the words in the blocks
    fingerprint: str  # of the parameters
    blocks: Mapping[str, SingleArray]  # by name
    eigenvalues: Mapping[str, SingleArray]  # by η, ascending


def shape_numbers(library: Library, shape_id: str) -> Numbers:
    """Return the numbers of a ready shape.

    Raises
    ------
    ShapeNotFound, NotReady
    """
    shape = library.catalogue.get(shape_id)
    if shape.status != Status.READY:
        raise NotReady(f"the shape is {shape.status}; only a ready one has numbers")
    vocabulary = vocabulary_for(library, str(shape.fingerprint))
    signatures = load_signatures(library.files, shape_id, shape.made_in)
    return Numbers(
        vocabulary_id=vocabulary.id,
        fingerprint=vocabulary.fingerprint,
        blocks=library.catalogue.blocks(shape_id, vocabulary.id),
        eigenvalues={
            name.removeprefix(EIGENVALUES): values
            for name, values in signatures.items()
            if name.startswith(EIGENVALUES)
        },
    )
