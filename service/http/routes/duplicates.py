"""Duplicates: the groups of a library, and what is none."""

from functools import partial
from typing import Annotated

from anyio import to_thread
from fastapi import APIRouter, Query

from index.errors import BadCursor, DismissalNotFound, NotAPair
from service.http.dependencies import LibraryPart, ServicesPart
from service.http.duplicate_schemas import DismissalModel, DismissalsModel, DuplicatesModel
from service.http.openapi import problems
from service.http.reasons import CHANGING, NEIGHBOURS, ONE_SHAPE, READING
from service.http.routes.shapes import Cursor, Limit
from service.relations.duplicates import USUAL, Kind, find_duplicates

router = APIRouter(tags=["duplicates"])

Groups = Annotated[int, Query(ge=1, le=100, description="groups of a page, about")]
Kinds = Annotated[
    list[Kind] | None,
    Query(
        description="by which relations shapes are joined; may be given more than once; "
        "default: all but re_posed"
    ),
]


@router.get(
    "/duplicates",
    operation_id="listDuplicates",
    summary="Groups of duplicates",
    responses=problems(*READING, *NEIGHBOURS, BadCursor),
)
async def list_duplicates(
    services: ServicesPart, limit: Groups = 20, cursor: Cursor = None, relation: Kinds = None
) -> DuplicatesModel:
    """Look through the library, some fifty shapes for a page, for shapes that are the same.

    Nothing is removed. A page may hold fewer groups than asked for, or none, while there are more pages:
    go on until `next_cursor` is null. Each shape is compared with the 48 nearest at most.
    """
    find = partial(
        find_duplicates,
        services.library,
        limit=limit,
        cursor=cursor,
        relations=USUAL if relation is None else relation,
    )
    return DuplicatesModel.of(await to_thread.run_sync(find, limiter=services.rankings))


@router.get(
    "/duplicates/dismissals",
    operation_id="listDismissals",
    summary="Pairs that are no duplicates",
    responses=problems(*READING, BadCursor),
)
def list_dismissals(library: LibraryPart, limit: Limit = 50, cursor: Cursor = None) -> DismissalsModel:
    """Return a page of the pairs that somebody dismissed, by ids."""
    return DismissalsModel.of(library.catalogue.dismissals(limit=limit, cursor=cursor))


@router.put(
    "/duplicates/dismissals/{one}/{other}",
    operation_id="dismissPair",
    summary="Say that two shapes are no duplicates",
    responses=problems(*CHANGING, *ONE_SHAPE, NotAPair),
)
async def dismiss(services: ServicesPart, one: str, other: str) -> DismissalModel:
    """Remember it: the two are in no group together any more. Their order does not matter."""
    act = partial(services.library.catalogue.dismiss, one, other)
    return DismissalModel.of(await to_thread.run_sync(act, limiter=services.writings))


@router.delete(
    "/duplicates/dismissals/{one}/{other}",
    operation_id="undismissPair",
    summary="Take back that two shapes are no duplicates",
    status_code=204,
    responses=problems(*CHANGING, DismissalNotFound),
)
async def undismiss(services: ServicesPart, one: str, other: str) -> None:
    """Forget it: the two may be in a group again."""
    act = partial(services.library.catalogue.undismiss, one, other)
    await to_thread.run_sync(act, limiter=services.writings)
