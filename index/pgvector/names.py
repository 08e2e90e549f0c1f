"""Names of what indexes keep in PostgreSQL."""

import zlib

from psycopg import sql

SCHEMA = "faience_index"
LOCKS = 0x66616965  # "faie": the first number of this project's advisory locks


def lock_number(method_name: str) -> int:
    """Return the second number of the lock that a method's writers hold, one after another."""
    return zlib.crc32(method_name.encode()) // 2 + 1  # fits a signed number of 32 bits


def table_of(method_name: str, number: int) -> sql.Identifier:
    """Return the name of a method's table; each one that is built anew has another number."""
    return sql.Identifier(SCHEMA, f"{method_name}-{number}")
