"""The one table of exceptions and HTTP statuses."""

import errno
import logging
from http import HTTPStatus

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from sqlalchemy.exc import OperationalError
from starlette.exceptions import HTTPException
from starlette.responses import JSONResponse

from index import errors as kept
from service.http.allowed import allowed_methods
from service.http.guards import CrossOrigin, ForeignHost, ReadOnlyKey
from service.http.problems import plain_problem, problem
from service.http.slow_bodies import SlowBody
from service.http.turnstile import TooBusy
from service.http.upload_rate import TooManyUploads
from service.intake.fields import BadField
from service.intake.multipart import (
    BadMultipart,
    FieldTooLong,
    IncompleteBody,
    NotMultipart,
    TooManyFiles,
    UploadRefused,
)
from service.intake.uploads import BodyTooLarge
from service.jobs.child import ChildError
from service.jobs.pool import ChildDied, PoolStopped
from service.jobs.recording import GAVE_UP, UNEXPECTED, UNEXPECTED_DETAIL
from service.key_ring import KeysUnreadable, Unauthorised
from service.remembering import QueryNotFound
from service.vocabularies import NoVocabulary
from service.watching.readiness import ShuttingDown, Unready
from service.why.errors import NotExplained
from worker.errors import MeshError

log = logging.getLogger(__name__)

# The nearest class of an exception's ancestry decides; a code is the exception's own or stands here.
TABLE: dict[type[Exception], tuple[HTTPStatus, str]] = {
    MeshError: (HTTPStatus.UNPROCESSABLE_ENTITY, "The mesh is refused"),
    BadField: (HTTPStatus.UNPROCESSABLE_ENTITY, "A field is refused"),
    UploadRefused: (HTTPStatus.UNPROCESSABLE_ENTITY, "The upload is refused"),
    BadMultipart: (HTTPStatus.BAD_REQUEST, "The body is not well-formed"),
    IncompleteBody: (HTTPStatus.BAD_REQUEST, "The body is not complete"),
    NotMultipart: (HTTPStatus.UNSUPPORTED_MEDIA_TYPE, "The body has the wrong media type"),
    BodyTooLarge: (HTTPStatus.REQUEST_ENTITY_TOO_LARGE, "The body is too large"),
    FieldTooLong: (HTTPStatus.REQUEST_ENTITY_TOO_LARGE, "A field is too long"),
    TooManyFiles: (HTTPStatus.REQUEST_ENTITY_TOO_LARGE, "Too many files or fields"),
    SlowBody: (HTTPStatus.REQUEST_TIMEOUT, "The body came too slowly"),
    Unauthorised: (HTTPStatus.UNAUTHORIZED, "A key is needed"),
    KeysUnreadable: (HTTPStatus.SERVICE_UNAVAILABLE, "The keys cannot be read"),
    ReadOnlyKey: (HTTPStatus.FORBIDDEN, "This key may only read"),
    TooManyUploads: (HTTPStatus.TOO_MANY_REQUESTS, "Too many uploads with one key"),
    ForeignHost: (HTTPStatus.FORBIDDEN, "The service is open to this machine alone"),
    CrossOrigin: (HTTPStatus.FORBIDDEN, "Another site's page may not do this"),
    kept.ShapeNotFound: (HTTPStatus.NOT_FOUND, "There is no such shape"),
    QueryNotFound: (HTTPStatus.NOT_FOUND, "There is no such query"),
    kept.DismissalNotFound: (HTTPStatus.NOT_FOUND, "There is no such dismissal"),
    kept.NotAPair: (HTTPStatus.UNPROCESSABLE_ENTITY, "These are no two shapes"),
    kept.FileMissing: (HTTPStatus.NOT_FOUND, "There is no such file"),
    kept.NotReady: (HTTPStatus.CONFLICT, "The shape is not ready"),
    kept.NotFailed: (HTTPStatus.CONFLICT, "The shape did not fail"),
    kept.BadCursor: (HTTPStatus.UNPROCESSABLE_ENTITY, "The cursor is refused"),
    kept.UnknownMethod: (HTTPStatus.UNPROCESSABLE_ENTITY, "There is no such method"),
    kept.BadWeights: (HTTPStatus.UNPROCESSABLE_ENTITY, "The weights are refused"),
    NotExplained: (HTTPStatus.UNPROCESSABLE_ENTITY, "This cannot be explained"),
    kept.BadBlock: (HTTPStatus.CONFLICT, "The shape's numbers do not fit"),
    kept.FingerprintMismatch: (HTTPStatus.CONFLICT, "The numbers belong to other parameters"),
    kept.DescriptionsChanging: (HTTPStatus.SERVICE_UNAVAILABLE, "The shapes are being described anew"),
    kept.NewerDescriptions: (HTTPStatus.SERVICE_UNAVAILABLE, "A newer version described this library"),
    kept.VocabularyChanged: (HTTPStatus.SERVICE_UNAVAILABLE, "The vocabulary is changing"),
    kept.StorageFull: (HTTPStatus.INSUFFICIENT_STORAGE, "The disk is full"),
    kept.StorageUnreachable: (HTTPStatus.SERVICE_UNAVAILABLE, "The files cannot be reached"),
    kept.CatalogueBusy: (HTTPStatus.SERVICE_UNAVAILABLE, "The catalogue is busy"),
    OperationalError: (HTTPStatus.SERVICE_UNAVAILABLE, "The catalogue cannot be reached"),
    NoVocabulary: (HTTPStatus.CONFLICT, "There is no vocabulary"),
    kept.BadVocabulary: (HTTPStatus.CONFLICT, "The vocabulary cannot be learnt"),
    TooBusy: (HTTPStatus.SERVICE_UNAVAILABLE, "Too many searches at once"),
    PoolStopped: (HTTPStatus.SERVICE_UNAVAILABLE, "The service is stopping"),
    Unready: (HTTPStatus.SERVICE_UNAVAILABLE, "A part of the service is not ready"),
    ShuttingDown: (HTTPStatus.SERVICE_UNAVAILABLE, "The service is shutting down"),
    ChildDied: (HTTPStatus.UNPROCESSABLE_ENTITY, "The mesh could not be described"),
    ChildError: (HTTPStatus.UNPROCESSABLE_ENTITY, "The mesh could not be described"),
}
CODES: dict[type[Exception], str] = {
    OperationalError: "busy",
    PoolStopped: "stopping",
    ChildDied: GAVE_UP,
    ChildError: UNEXPECTED,
}
# What these say is for the log only.
DETAILS: dict[type[Exception], str] = {
    OperationalError: "try again in a moment",
    ChildError: UNEXPECTED_DETAIL,
}
INVALID_REQUEST, INTERNAL_ERROR = "invalid_request", "internal_error"  # for what is no class of ours
FULL = {errno.ENOSPC, errno.EDQUOT}


def add_handlers(app: FastAPI) -> None:
    """Give every exception its answer."""
    for known in TABLE:
        app.add_exception_handler(known, _known)
    app.add_exception_handler(RequestValidationError, _invalid)
    app.add_exception_handler(HTTPException, _http)
    app.add_exception_handler(OSError, _system)
    app.add_exception_handler(Exception, unexpected)


def _known(request: Request, error: Exception) -> JSONResponse:
    kind = next(kind for kind in type(error).__mro__ if kind in TABLE)
    status, title = TABLE[kind]
    code = CODES.get(kind) or str(getattr(error, "code", "error"))
    if kind in DETAILS:
        log.error("%s %s: %s", request.method, request.url.path, title, exc_info=error)
        return problem(status, code=code, title=title, detail=DETAILS[kind])
    members = getattr(error, "members", {})  # beyond those of every problem
    detail = str(getattr(error, "detail", "") or error)
    response = problem(status, code=code, title=title, detail=detail, **members)
    response.headers.update(getattr(error, "headers", {}))
    return response


def _invalid(_: Request, error: Exception) -> JSONResponse:
    """Name the parts of a request that FastAPI refused, without repeating what was sent."""
    found = error.errors() if isinstance(error, RequestValidationError) else []
    parts = [{"where": ".".join(map(str, part["loc"])), "what": part["msg"]} for part in found]
    detail = "; ".join(f"{part['where']}: {part['what']}" for part in parts[:5]) or "the request is not valid"
    status, title = HTTPStatus.UNPROCESSABLE_ENTITY, "The request is not valid"
    return problem(status, code=INVALID_REQUEST, title=title, detail=detail, errors=parts)


def _http(request: Request, error: Exception) -> JSONResponse:
    """Answer what the framework itself refuses: unknown paths, methods, unreadable bodies."""
    status = error.status_code if isinstance(error, HTTPException) else HTTPStatus.INTERNAL_SERVER_ERROR
    response = plain_problem(status)
    response.headers.update(getattr(error, "headers", None) or {})
    if status == HTTPStatus.METHOD_NOT_ALLOWED:
        response.headers["Allow"] = allowed_methods(request)
    return response


def _system(request: Request, error: Exception) -> JSONResponse:
    if isinstance(error, OSError) and error.errno in FULL:
        status, title = TABLE[kept.StorageFull]
        return problem(status, code="storage_full", title=title, detail="nothing of this request was kept")
    return unexpected(request, error)


def unexpected(request: Request, error: Exception) -> JSONResponse:
    """Answer a defect: its inside is for the log only."""
    log.error("%s %s failed", request.method, request.url.path, exc_info=error)
    status, title = HTTPStatus.INTERNAL_SERVER_ERROR, "Something went wrong here"
    detail = "the service's log says more; the request can be tried again"
    return problem(status, code=INTERNAL_ERROR, title=title, detail=detail)
