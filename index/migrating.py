"""Migrating: a database is brought to the schema of this version, step by step, in one transaction."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib.resources import as_file, files

from alembic import command
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Engine

from index.database import named_failures
from index.postgresql import migrate_one_at_a_time
from index.sqlite import WRITES, check_keys, let_tables_be_made_anew

SCRIPTS = files("index") / "migrations"  # Alembic's steps


def migrate(engine: Engine, upto: str = "head") -> None:
    """Bring the schema to this version's, or up to one revision; several processes may do so at once."""
    on_sqlite = engine.dialect.name == "sqlite"
    writer = engine.execution_options(**{WRITES: True})
    with migrations() as config, named_failures(), writer.connect() as connection:
        if on_sqlite:
            let_tables_be_made_anew(connection)
        with connection.begin():
            if not on_sqlite:
                migrate_one_at_a_time(connection)
            before = MigrationContext.configure(connection).get_current_revision()
            if before == ScriptDirectory.from_config(config).get_current_head():
                return
            config.attributes["connection"] = connection
            command.upgrade(config, upto)
            after = MigrationContext.configure(connection).get_current_revision()
            if on_sqlite and before != after:
                check_keys(connection)


@contextmanager
def migrations() -> Iterator[Config]:
    """Lend Alembic's view of the steps that this version knows."""
    with as_file(SCRIPTS) as scripts:
        config = Config()
        config.set_main_option("script_location", str(scripts).replace("%", "%%"))
        config.set_main_option("path_separator", "os")
        yield config
