"""A library's database alone, for commands that need nothing else of it."""

import contextlib
from collections.abc import Iterator
from pathlib import Path

from sqlalchemy import Engine

from index.database import make_engine
from index.migrating import migrate
from service.commands.failures import CommandFailed
from service.settings import Settings


@contextlib.contextmanager
def opened_database(data_dir: Path, *, maker: str, make: bool = False) -> Iterator[Engine]:
    """Open the database of a library, brought to this version.

    Parameters
    ----------
    maker : str
        The command that makes a library where there is none.
    make : bool
        Whether this is it.

    Raises
    ------
    CommandFailed
        There is no library.
    """
    settings = Settings(data_dir=data_dir)
    if make:
        data_dir.mkdir(parents=True, exist_ok=True)
    elif settings.database_url is None and not data_dir.is_dir():
        raise CommandFailed(f"there is no library at {data_dir}; `{maker}` makes one")
    engine = make_engine(settings.url)
    try:
        migrate(engine)
        yield engine
    finally:
        engine.dispose()
