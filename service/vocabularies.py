"""The active vocabulary, and how a library learns its own."""

from collections.abc import Callable, Iterator

from index.errors import FileMissing, ShapeNotFound
from index.shapes import Status
from index.vocabulary import Vocabulary
from index.vocabulary import learn_vocabulary as learn
from service.library import Library
from service.quantisation import quantise
from service.storage import load_signatures
from worker.arrays import SingleArray

BATCH = 100  # shapes between two questions to the catalogue
NONE_ACTIVE = "no vocabulary is active; learn one with `faience learn-vocabulary`"
Progress = Callable[[int, int], None]  # shapes done, shapes known so far


class NoVocabulary(Exception):
    """No vocabulary of these parameters is active; one must be learnt first."""

    code = "no_vocabulary"


def known_vocabulary(vocabulary_id: str | None) -> str:
    """Return the id of the active vocabulary, as the catalogue told it; NoVocabulary for None."""
    if vocabulary_id is None:
        raise NoVocabulary(NONE_ACTIVE)
    return vocabulary_id


def active_vocabulary(library: Library) -> Vocabulary:
    """Return the vocabulary that queries and records use now."""
    known = library.vocabularies.get(library.catalogue.state().vocabulary_id or "")
    return known or _read_active(library)


def learn_vocabulary(library: Library, progress: Progress = lambda *_: None) -> Vocabulary:
    """Learn a vocabulary from all ready shapes, quantise them by it, then make it the active one.

    Nothing is solved again: the signatures are stored. Until the last step queries are answered with
    the vocabulary that was active before.

    Parameters
    ----------
    progress : callable
        Told how many shapes are quantised, of how many.

    Raises
    ------
    BadVocabulary
        Where the ready shapes are too few, or too alike.
    """
    vocabulary = learn(_all_signatures(library), library.parameters.fingerprint())
    adopt_vocabulary(library, vocabulary, progress)
    return vocabulary


def adopt_vocabulary(library: Library, vocabulary: Vocabulary, progress: Progress) -> None:
    """Quantise every ready shape by ``vocabulary``, those that become ready meanwhile too; activate it."""
    library.catalogue.add_vocabulary(vocabulary)
    done = 0
    while not library.catalogue.activate(vocabulary.id):
        for shape_id in library.catalogue.missing_from(vocabulary.id, BATCH):
            _quantise_shape(library, vocabulary, shape_id)
            done += 1
            progress(done, max(done, library.catalogue.counts()[Status.READY]))


def _quantise_shape(library: Library, vocabulary: Vocabulary, shape_id: str) -> None:
    try:
        signatures = load_signatures(library.files, shape_id)
        library.catalogue.add_quantised(shape_id, vocabulary.id, quantise(signatures, vocabulary))
    except (FileMissing, ShapeNotFound):
        if shape_id in library.catalogue.get_many([shape_id]):
            raise  # it is not gone: its signatures are, and that must be known


def _all_signatures(library: Library) -> Iterator[dict[str, SingleArray]]:
    cursor = None
    while True:
        page = library.catalogue.list(limit=BATCH, cursor=cursor, status=Status.READY)
        for shape in page.items:
            try:
                yield load_signatures(library.files, shape.id)
            except FileMissing:
                continue  # removed while this goes on
        cursor = page.next_cursor
        if cursor is None:
            return


def _read_active(library: Library) -> Vocabulary:
    vocabulary = library.catalogue.active_vocabulary()
    if vocabulary is None:
        raise NoVocabulary(NONE_ACTIVE)
    library.vocabularies.clear()  # one at a time is asked for
    library.vocabularies[vocabulary.id] = vocabulary
    return vocabulary
