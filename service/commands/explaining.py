"""Exceptions of all parts in plain words."""

from alembic.util import CommandError
from pydantic import ValidationError
from sqlalchemy.exc import SQLAlchemyError

from index.errors import CatalogueError, ExportRefused
from service.jobs.pool import ChildDied, PoolStopped
from service.listening import UnsafeListening
from service.vocabularies import NoVocabulary
from worker.errors import MeshError

PLAIN = (CatalogueError, NoVocabulary, UnsafeListening, ChildDied, PoolStopped)  # their text says it all


def explain(error: Exception) -> str | None:
    """Return what an exception means for the user, or None for a defect of our own."""
    if isinstance(error, ExportRefused):
        return f"{error} ({error.code})"
    if isinstance(error, PLAIN):
        return str(error)
    if isinstance(error, MeshError):
        return f"{error.detail} ({error.code})"
    if isinstance(error, CommandError):
        return "the library was made by a newer version of Faience; update Faience, or use another --data-dir"
    if isinstance(error, ValidationError):
        return "; ".join(_setting(part["loc"], part["msg"]) for part in error.errors())
    if isinstance(error, SQLAlchemyError):
        return f"the library's database cannot be used: {getattr(error, 'orig', None) or error}"
    if isinstance(error, OSError):
        where = f": {error.filename}" if error.filename else ""
        return f"{(error.strerror or str(error)).lower()}{where}"
    return None


def _setting(place: tuple[int | str, ...], message: str) -> str:
    return f"the setting {'.'.join(map(str, place))} is refused: {message}"
