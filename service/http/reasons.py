"""Which errors a call may answer: their statuses and codes, from the one table of exceptions."""

from collections.abc import Iterable, Iterator
from http import HTTPStatus

from fastapi.exceptions import RequestValidationError
from sqlalchemy.exc import OperationalError

from index import errors as kept
from service.http.errors import CODES, INTERNAL_ERROR, INVALID_REQUEST, TABLE
from service.http.guards import CrossOrigin, ForeignHost, ReadOnlyKey
from service.http.problems import PLAIN_CODES
from service.http.slow_bodies import SlowBody
from service.http.turnstile import TooBusy
from service.http.upload_rate import TooManyUploads
from service.intake.fields import BadField, BadMetadata, UnreadableWeights
from service.intake.multipart import (
    BadMultipart,
    FieldTooLong,
    IncompleteBody,
    NotMultipart,
    TooManyFiles,
    UploadRefused,
)
from service.intake.uploads import BodyTooLarge, NoFiles
from service.jobs.child import ChildError
from service.jobs.pool import ChildDied, PoolStopped
from service.jobs.recording import GAVE_UP, UNEXPECTED
from service.key_ring import KeysUnreadable, Unauthorised
from service.remembering import QueryNotFound
from service.vocabularies import NoVocabulary
from service.watching.readiness import ShuttingDown, Unready
from service.why.errors import NotExplained
from worker.errors import Code, MeshError

Reason = type[Exception] | int  # one of the table, or a status with which HTTP or the framework refuses

EVERY: tuple[Reason, ...] = (400, 408, 431, 503, Exception)  # of any call: no HTTP, too slow, a defect
KEYS: tuple[Reason, ...] = (Unauthorised, ForeignHost, KeysUnreadable)
CATALOGUE: tuple[Reason, ...] = (kept.CatalogueBusy, OperationalError)
READING: tuple[Reason, ...] = (*KEYS, *CATALOGUE, kept.StorageUnreachable, RequestValidationError)
CHANGING: tuple[Reason, ...] = (*READING, CrossOrigin, ReadOnlyKey, kept.StorageFull)
ONE_SHAPE: tuple[Reason, ...] = (kept.ShapeNotFound,)
ONE_QUERY: tuple[Reason, ...] = (QueryNotFound,)
FILE: tuple[Reason, ...] = (kept.FileMissing, 416)
VERSIONS: tuple[Reason, ...] = (kept.DescriptionsChanging, kept.NewerDescriptions)
NUMBERS: tuple[Reason, ...] = (
    *VERSIONS,
    kept.NotReady,
    kept.FileMissing,
    NoVocabulary,
    kept.BadVocabulary,
    kept.BadBlock,
)
DETAILS: tuple[Reason, ...] = (BadField, BadMetadata, SlowBody, 413)
UPLOAD: tuple[Reason, ...] = (
    *(NotMultipart, BadMultipart, IncompleteBody, SlowBody, BodyTooLarge, FieldTooLong, TooManyFiles),
    *(NoFiles, BadField, BadMetadata, MeshError, TooManyUploads, CrossOrigin, kept.StorageFull),
)
QUESTION: tuple[Reason, ...] = (
    *VERSIONS,
    *(kept.UnknownMethod, kept.BadWeights, UnreadableWeights, kept.VocabularyChanged, NoVocabulary),
    *(kept.FingerprintMismatch, kept.BadBlock, kept.BadVocabulary),
)
NEIGHBOURS: tuple[Reason, ...] = (
    *VERSIONS,
    *(kept.VocabularyChanged, NoVocabulary, kept.FingerprintMismatch, kept.BadBlock, kept.BadVocabulary),
)
EXPLAINING: tuple[Reason, ...] = (*QUESTION, kept.FileMissing, kept.NotReady, NotExplained)
READINESS: tuple[Reason, ...] = (Unready, ShuttingDown)
DESCRIBING: tuple[Reason, ...] = (TooBusy, PoolStopped, ChildDied, ChildError)

# Why a shape may be `failed`: what the worker finds, and what ends a job that finds nothing.
FAILURES: tuple[str, ...] = (*map(str, Code), GAVE_UP, UNEXPECTED)


def codes_of(reason: Reason) -> Iterator[tuple[int, str]]:
    """Yield the status and each code of a reason."""
    if isinstance(reason, int):
        yield reason, PLAIN_CODES[reason]
    elif reason is RequestValidationError:
        yield HTTPStatus.UNPROCESSABLE_ENTITY, INVALID_REQUEST
    elif reason is Exception:
        yield HTTPStatus.INTERNAL_SERVER_ERROR, INTERNAL_ERROR
    else:
        kind = next(kind for kind in reason.__mro__ if kind in TABLE)
        status, _ = TABLE[kind]
        own = Code if reason is MeshError else (CODES.get(kind) or getattr(reason, "code", ""),)
        yield from ((int(status), str(code)) for code in own)


def by_status(reasons: Iterable[Reason]) -> dict[int, list[str]]:
    """Return the codes that may come with each status, both ascending."""
    pairs = {pair for reason in reasons for pair in codes_of(reason)}
    return {status: sorted(code for at, code in pairs if at == status) for status in sorted(dict(pairs))}


def all_codes() -> dict[int, list[str]]:
    """Return every code of the interface by status; what comes only with a failed shape is elsewhere."""
    of_table: set[Reason] = {kind for kind in TABLE if kind is not UploadRefused}  # never raised itself
    of_framework: set[Reason] = {*PLAIN_CODES, RequestValidationError, Exception}
    return by_status(of_table | of_framework | {*DETAILS, *UPLOAD, *QUESTION})
