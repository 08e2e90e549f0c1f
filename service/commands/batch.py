"""Indexing many meshes: each is known, or accepted and waited for, or refused."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import StrEnum

from index.shapes import Shape, Status
from service.commands.companions import Companions
from service.commands.discovery import Found, Source
from service.commands.opening import Helper
from service.intake.submissions import receive_paths
from service.library import Library
from service.retrieval import accept_upload
from worker.errors import MeshError

LOOK_EVERY = 1.0  # seconds after which shapes are looked at unasked: another process may have done them


class Result(StrEnum):
    """What became of a mesh."""

    ACCEPTED = "accepted"  # it is in the library now
    KNOWN = "known"  # the same content was in the library before
    REFUSED = "refused"  # it cannot be read


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What became of one path."""

    path: str  # as the user would write it
    result: Result
    shape_id: str | None  # in the library; None where it was refused at once
    code: str | None  # why it was refused
    detail: str | None  # the same in words


@dataclass(frozen=True, kw_only=True)
class Waiting:
    """A path whose shape is queued or computed."""

    mesh: Found
    new: bool  # whether this run brought it


def index_sources(
    library: Library, sources: Iterable[Source], allow_untextured: bool, helper: Helper, ahead: int
) -> Iterator[Outcome]:
    """Bring every mesh into the library, in parallel through its queue.

    Parameters
    ----------
    helper : Helper
        The worker beside this command.
    ahead : int
        Shapes that wait at the same time, for each that is described; so few are left over when the user
        stops the command.

    Yields
    ------
    Outcome
        One for each mesh, as they become final.
    """
    waiting: dict[str, list[Waiting]] = {}
    for source in sources:
        companions = Companions(source, library.limits)
        for mesh in source.meshes:
            yield from _accept(library, companions, mesh, allow_untextured, waiting)
            helper.wake()
            yield from _settled(library, waiting, helper, ahead * max(helper.slots(), 1))
    yield from _settled(library, waiting, helper, 0)


def _accept(
    library: Library,
    companions: Companions,
    mesh: Found,
    allow_untextured: bool,
    waiting: dict[str, list[Waiting]],
) -> Iterator[Outcome]:
    """Hand a mesh in; yield its outcome where it is final already."""
    try:
        files = companions.files_of(mesh)
        submission = receive_paths(files, name=mesh.name, allow_untextured=allow_untextured)
        shape, new = accept_upload(library, submission)
    except MeshError as error:
        yield _outcome(mesh, Result.REFUSED, code=str(error.code), detail=error.detail)
        return
    except (FileNotFoundError, PermissionError) as error:  # it went away, or is not ours to read
        detail = (error.strerror or str(error)).lower()
        yield _outcome(mesh, Result.REFUSED, code="unreadable", detail=detail)
        return
    waiting.setdefault(shape.id, []).append(Waiting(mesh=mesh, new=new))


def _settled(
    library: Library, waiting: dict[str, list[Waiting]], helper: Helper, most: int
) -> Iterator[Outcome]:
    """Yield what is final by now; wait while more than ``most`` shapes are not."""
    if len(waiting) <= most and not helper.settled.is_set():
        return
    while True:
        helper.settled.clear()
        shapes = library.catalogue.get_many(waiting)
        for shape_id in list(waiting):
            shape = shapes.get(shape_id)
            if shape is None or shape.status in (Status.READY, Status.FAILED):
                for each in waiting.pop(shape_id):
                    yield _final(each, shape)
        if len(waiting) <= most:
            return
        helper.settled.wait(LOOK_EVERY)


def _final(each: Waiting, shape: Shape | None) -> Outcome:
    if shape is None:
        return _outcome(each.mesh, Result.REFUSED, code="not_found", detail="it was removed meanwhile")
    if shape.status == Status.FAILED:
        code, detail = shape.error_code, shape.error_detail
        return _outcome(each.mesh, Result.REFUSED, shape_id=shape.id, code=code, detail=detail)
    return _outcome(each.mesh, Result.ACCEPTED if each.new else Result.KNOWN, shape_id=shape.id)


def _outcome(
    mesh: Found,
    result: Result,
    *,
    shape_id: str | None = None,
    code: str | None = None,
    detail: str | None = None,
) -> Outcome:
    return Outcome(path=str(mesh.path), result=result, shape_id=shape_id, code=code, detail=detail)
