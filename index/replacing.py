"""Replacing: an empty library becomes the one that was staged, in one transaction."""

from sqlalchemy import Connection, Engine, Table, func, insert, select, update

from index.database import writing
from index.dumping import FREE_JOB
from index.errors import LibraryNotEmpty
from index.postgresql import go_on_after
from index.revisions import lock_state
from index.schema import library_tables
from index.shapes import CatalogueState, Status
from index.tables import JobRow, ShapeRow, StateRow

_ROWS = 500  # of one statement


def replace_library(engine: Engine, staged: Engine) -> None:
    """Fill the catalogue of a library without shapes; both have this version's schema.

    Ids, moments, revisions and the order of the list stay what they were. Whoever has the library open
    notices: it has another name then or, where it once was the same library, a new epoch.

    Raises
    ------
    LibraryNotEmpty
        There is a shape; nothing was changed.
    """
    with staged.connect() as source, writing(engine) as session:
        before = lock_state(session)
        known = CatalogueState(
            library=before.library, revision=before.revision, epoch=before.epoch, vocabulary_id=None
        )
        check_empty(session.scalars(select(func.count()).select_from(ShapeRow)).one())
        target = session.connection()
        tables = library_tables(target)
        for table in reversed(tables):
            target.execute(table.delete())
        for table in tables:
            _copy(source, target, table)
        _free_jobs(target)
        _go_on_after(target, known)


def check_empty(n_shapes: int) -> None:
    """Refuse a library that holds shapes; LibraryNotEmpty."""
    if n_shapes:
        raise LibraryNotEmpty(
            f"an import needs a library without shapes, this one has {n_shapes}; name another --data-dir"
        )


def _copy(source: Connection, target: Connection, table: Table) -> None:
    rows = source.execute(select(table), execution_options={"yield_per": _ROWS}).mappings()
    for part in rows.partitions():
        target.execute(insert(table), [dict(row) for row in part])
    if target.dialect.name == "postgresql":
        go_on_after(target, table)


def _free_jobs(target: Connection) -> None:
    """Trust no lease from elsewhere: a job would wait for a worker that is not here."""
    target.execute(update(JobRow).values(FREE_JOB))
    held = update(ShapeRow).where(ShapeRow.status == Status.PROCESSING)
    target.execute(held.values(status=Status.QUEUED))


def _go_on_after(target: Connection, before: CatalogueState) -> None:
    """Let no number that somebody remembers of the library mean something else from now on."""
    target.execute(
        update(StateRow).where(StateRow.revision < before.revision).values(revision=before.revision)
    )
    same = StateRow.library == before.library
    epoch = max(before.epoch, target.scalar(select(StateRow.epoch)) or 0) + 1
    target.execute(update(StateRow).where(same).values(epoch=epoch))
