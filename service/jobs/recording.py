"""What becomes of a job: its description is stored, or the reason why there is none."""

from dataclasses import asdict

from index.errors import CatalogueError, LeaseLost, ShapeNotFound, VocabularyChanged
from index.jobs import Job
from index.shapes import Shape
from service.jobs.describing import InWords
from service.library import Library
from service.quantisation import quantise
from service.storage import PREVIEW, THUMBNAIL, derived_key, save_signatures
from service.vocabularies import active_vocabulary
from worker.describe import Description

ATTEMPTS = 5  # while vocabularies change

# Codes beside those of worker.errors.Code.
GAVE_UP = "gave_up"  # its process died again and again; also given by index.queue
UNEXPECTED = "unexpected"  # a defect of ours
UNEXPECTED_DETAIL = "the mesh could not be described, for a reason of our own; the log says more"


def record_description(
    library: Library, job: Job, description: Description, in_words: InWords | None = None
) -> Shape:
    """Store what was computed: files first, then everything else in one transaction.

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
        library.files.put(derived_key(shape_id, THUMBNAIL), description.thumbnail)
        library.files.put(derived_key(shape_id, PREVIEW), description.preview)
        save_signatures(library.files, shape_id, description.signatures)
        return _record(library, job, description, in_words)
    except (LeaseLost, ShapeNotFound):
        if shape_id not in library.catalogue.get_many([shape_id]):
            library.files.delete_all(f"shapes/{shape_id}")
        raise


def _record(library: Library, job: Job, description: Description, in_words: InWords | None) -> Shape:
    for _ in range(ATTEMPTS):
        vocabulary = active_vocabulary(library)
        if in_words is None or in_words.vocabulary_id != vocabulary.id:
            blocks = quantise(description.signatures, vocabulary)
            in_words = InWords(vocabulary_id=vocabulary.id, blocks=blocks)
        try:
            return library.catalogue.record_ready(
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
