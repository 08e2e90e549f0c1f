"""The schema as a database has it: its revision, and the tables that make a library."""

from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import JSON, Connection, MetaData, Table

from index.migrating import migrations

# Alembic's own; keys and webhooks belong to the house, how fast jobs were to the machine, not to the library.
LEFT_OUT = frozenset({"alembic_version", "api_keys", "webhooks", "deliveries", "finished_jobs"})


def revision_of(connection: Connection) -> str:
    """Return the migration that a database was brought to."""
    revision = MigrationContext.configure(connection).get_current_revision()
    if revision is None:
        raise ValueError("a database that was never migrated has no revision")
    return revision


def is_known(revision: str) -> bool:
    """Tell whether this version has the migration of that name."""
    with migrations() as config:
        steps = ScriptDirectory.from_config(config).walk_revisions()
        return revision in {step.revision for step in steps}


def library_tables(connection: Connection) -> list[Table]:
    """Return the tables whose rows make a library, as the database describes them.

    A table comes after those that its rows refer to. What a later version adds comes along by itself.
    """
    metadata = MetaData()
    metadata.reflect(connection)
    tables = [table for table in metadata.sorted_tables if table.name not in LEFT_OUT]
    for table in tables:
        for column in table.columns:
            if isinstance(column.type, JSON):
                column.type.none_as_null = True  # as `index.tables` has it; the database does not know
    return tables
