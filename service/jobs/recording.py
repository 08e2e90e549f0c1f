"""What becomes of a job: its description is stored, or the reason why there is none."""

import logging
from dataclasses import asdict

from index.errors import CatalogueError, LeaseLost, ShapeNotFound, VocabularyChanged
from index.jobs import Job
from index.shapes import Shape
from service.jobs.describing import InWords
from service.library import Library
from service.quantisation import quantise
from service.storage import PREVIEW, THUMBNAIL, derived_key, save_signatures
from service.vocabularies import own_vocabulary
from worker.describe import Description

log = logging.getLogger(__name__)

ATTEMPTS = 5  # while vocabularies change

# Codes beside those of worker.errors.Code.
GAVE_UP = "gave_up"  # its process died again and again; also given by index.queue
UNEXPECTED = "unexpected"  # a defect of ours
UNEXPECTED_DETAIL = "the mesh could not be described, for a reason of our own; the log says more"


def record_description(
    library: Library, job: Job, description: Description, in_words: InWords | None = None
) -> Shape:
    """Store what was computed: files first, then everything else in one transaction.

    A shape that is described anew keeps its earlier description beside it, and answers with that.

    Parameters
    ----------
    in_words : InWords, optional
        The description in the words of the vocabulary that was active when the job began; where another is
        active now it is quantised anew.

    Raises
    ------
    LeaseLost
        The job is not this worker's any more, or its shape was removed; then nothing is left behind.
    """
    shape_id = job.shape_id
    try:
        made_in = job.fingerprint  # files that answer now are not touched
        library.files.put(derived_key(shape_id, THUMBNAIL, made_in), description.thumbnail)
        library.files.put(derived_key(shape_id, PREVIEW, made_in), description.preview)
        save_signatures(library.files, shape_id, description.signatures, made_in)
        return _record(library, job, description, in_words)
    except (LeaseLost, ShapeNotFound):
        if shape_id not in library.catalogue.get_many([shape_id]):
            library.files.delete_all(f"shapes/{shape_id}")
        raise


def record_failure(library: Library, job: Job, code: str, detail: str) -> None:
    """Store why there is no description; LeaseLost as for `record_description`."""
    if job.fingerprint is None:
        library.catalogue.record_failed(job, code=code, detail=detail)
    else:
        library.catalogue.record_not_renewed(job, code=code, detail=detail)
        log.warning("shape %s cannot be described anew, %s: %s", job.shape_id, code, detail)


def _record(library: Library, job: Job, description: Description, in_words: InWords | None) -> Shape:
    catalogue = library.catalogue
    record = catalogue.record_ready if job.fingerprint is None else catalogue.record_renewed
    for _ in range(ATTEMPTS):
        vocabulary = own_vocabulary(library)
        if in_words is None or in_words.vocabulary_id != vocabulary.id:
            blocks = quantise(description.signatures, vocabulary)
            in_words = InWords(vocabulary_id=vocabulary.id, blocks=blocks)
        try:
            return record(
                job,
                facts=asdict(description.facts),
                fingerprint=description.fingerprint,
                blocks=description.blocks,
                quantised=in_words.blocks,
                vocabulary_id=vocabulary.id,
            )
        except VocabularyChanged:
            continue
    raise CatalogueError("vocabularies kept changing while a description was stored")
