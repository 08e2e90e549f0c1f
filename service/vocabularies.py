"""The active vocabulary, and how a library learns its own."""

import contextlib
from collections.abc import Callable, Iterator

from index.errors import DescriptionsChanging, FileMissing, NewerDescriptions, ShapeNotFound
from index.shapes import Status
from index.vocabulary import Vocabulary
from index.vocabulary import learn_vocabulary as learn
from service.library import NEWER, Library
from service.quantisation import quantise
from service.storage import load_signatures
from worker.arrays import SingleArray

REMEMBERED = 2  # vocabularies: the active and the next one
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
    return _stored(library, known_vocabulary(library.catalogue.state().vocabulary_id))


def vocabulary_for(library: Library, fingerprint: str) -> Vocabulary:
    """Return the vocabulary of the parameters that something was described with: the active or the next one.

    Raises
    ------
    NoVocabulary
        There is none yet.
    DescriptionsChanging
        Shapes will be described with these parameters, but that has not begun.
    NewerDescriptions
        They were described with these once, and are not any more.
    """
    state = library.catalogue.state()
    active = _stored(library, known_vocabulary(state.vocabulary_id))
    if active.fingerprint == fingerprint:
        return active
    if state.next_vocabulary_id is not None:
        upcoming = _stored(library, state.next_vocabulary_id)
        if upcoming.fingerprint == fingerprint:
            return upcoming
    if library.catalogue.left_behind(fingerprint):
        raise NewerDescriptions(NEWER)
    raise DescriptionsChanging(
        "all shapes are to be described anew for this version; that begins when a worker of it runs"
    )


def own_vocabulary(library: Library) -> Vocabulary:
    """Return the vocabulary for what this program describes; as `vocabulary_for`."""
    return vocabulary_for(library, library.parameters.fingerprint())


def settled_vocabulary(library: Library) -> Vocabulary:
    """Return the active vocabulary where it is this program's own.

    Raises
    ------
    NoVocabulary, NewerDescriptions
    DescriptionsChanging
        The shapes answer with earlier descriptions, which this version cannot make or look into.
    """
    own, active = own_vocabulary(library), active_vocabulary(library)
    if own.fingerprint != active.fingerprint:
        raise DescriptionsChanging(
            "all shapes are being described anew for this version; try again after that"
        )
    return active


def check_not_behind(library: Library, vocabulary_id: str) -> None:
    """Refuse to compare in words that came with a newer version; NewerDescriptions.

    Words of an earlier version may be compared with each other, as that version did.
    """
    if _stored(library, vocabulary_id).fingerprint != library.parameters.fingerprint():
        with contextlib.suppress(DescriptionsChanging):
            own_vocabulary(library)


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
    DescriptionsChanging
        They are being described anew.
    """
    with contextlib.suppress(NoVocabulary):
        settled_vocabulary(library)
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
        made_in = library.catalogue.get(shape_id).made_in
        signatures = load_signatures(library.files, shape_id, made_in)
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
                yield load_signatures(library.files, shape.id, shape.made_in)
            except FileMissing:
                continue  # removed while this goes on
        cursor = page.next_cursor
        if cursor is None:
            return


def _stored(library: Library, vocabulary_id: str) -> Vocabulary:
    known = library.vocabularies.get(vocabulary_id)
    if known is None:
        known = library.catalogue.vocabulary(vocabulary_id)
        if len(library.vocabularies) >= REMEMBERED:
            library.vocabularies.clear()
        library.vocabularies[vocabulary_id] = known
    return known
