"""A remembered query in the words of the active vocabulary."""

import io

import numpy as np

from service.library import Library
from service.quantisation import quantise
from service.remembering import Remembered, remembered_file
from service.storage import SIGNATURES
from service.vocabularies import own_vocabulary
from worker.arrays import SingleArray


def in_active_words(library: Library, query: Remembered) -> tuple[str, dict[str, SingleArray]]:
    """Return the id of this version's vocabulary and the query's blocks in its words.

    They are kept in those of the vocabulary that was active when the query came; where another is active now,
    they are made anew from its signatures.

    Raises
    ------
    QueryNotFound
        It was removed in this moment.
    """
    vocabulary = own_vocabulary(library)
    if vocabulary.id == query.vocabulary_id:
        return vocabulary.id, dict(query.blocks)
    return vocabulary.id, {**query.blocks, **quantise(remembered_signatures(library, query.id), vocabulary)}


def remembered_signatures(library: Library, query_id: str) -> dict[str, SingleArray]:
    """Return the signatures of a remembered query; QueryNotFound where it was removed in this moment."""
    data = remembered_file(library, query_id, SIGNATURES)
    with np.load(io.BytesIO(data), allow_pickle=False) as archive:
        return {name: archive[name] for name in archive.files}
