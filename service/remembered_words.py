"""A remembered query in the words of the active vocabulary."""

import io

import numpy as np

from index.errors import FileMissing
from service.library import Library
from service.quantisation import quantise
from service.remembering import QueryNotFound, Remembered, query_key
from service.storage import SIGNATURES
from service.vocabularies import active_vocabulary
from worker.arrays import SingleArray


def in_active_words(library: Library, query: Remembered) -> tuple[str, dict[str, SingleArray]]:
    """Return the active vocabulary's id and the query's blocks in its words.

    They are kept in those of the vocabulary that was active when the query came; where another is active now,
    they are made anew from its signatures.

    Raises
    ------
    QueryNotFound
        It was removed in this moment.
    """
    vocabulary = active_vocabulary(library)
    if vocabulary.id == query.vocabulary_id:
        return vocabulary.id, dict(query.blocks)
    return vocabulary.id, {**query.blocks, **quantise(remembered_signatures(library, query.id), vocabulary)}


def remembered_signatures(library: Library, query_id: str) -> dict[str, SingleArray]:
    """Return the signatures of a remembered query; QueryNotFound where it was removed in this moment."""
    try:
        data = library.files.get(query_key(query_id, SIGNATURES))
    except FileMissing:
        raise QueryNotFound("this query is not remembered any more; send its mesh again") from None
    with np.load(io.BytesIO(data), allow_pickle=False) as archive:
        return {name: archive[name] for name in archive.files}
