"""The API keys of a library: made, listed, revoked, and told to those who guard its doors."""

from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path

from sqlalchemy import Engine, inspect, make_url, select

from index.database import make_engine, reading, writing
from index.errors import BadKeyName, KeyNotFound
from index.key_secrets import digest_of, make_secret
from index.revisions import now
from index.scopes import Scope
from index.tables import ApiKeyRow

NAME_LENGTH = 100  # characters


@dataclass(frozen=True, kw_only=True)
class ApiKey:
    """What may be told about a key."""

    id: str  # public, part of the key itself
    name: str  # whose it is, for people
    scope: Scope  # what it allows
    created_at: datetime  # UTC
    revoked_at: datetime | None  # UTC; None while it opens


@dataclass(frozen=True, kw_only=True)
class ActiveKey:
    """What a guard compares with."""

    id: str
    digest: bytes = field(repr=False)  # SHA-256 of the key
    scope: Scope
    name: str = ""  # whose it is, for the log


class Keys:
    """The keys of one library; each method is one transaction.

    Parameters
    ----------
    engine : Engine
        From `index.database.make_engine`, with a schema that `migrate` brought up to date.
    """

    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    def create(self, name: str, scope: Scope) -> tuple[ApiKey, str]:
        """Make a key.

        Returns
        -------
        ApiKey, str
            What is known of it from now on, and the key itself, which cannot be told again.

        Raises
        ------
        BadKeyName
        """
        name = _checked(name)
        key_id, secret = make_secret()
        row = ApiKeyRow(
            id=key_id, name=name, digest=digest_of(secret.encode()), scope=scope, created_at=now()
        )
        with writing(self._engine) as session:
            session.add(row)
            session.flush()
            return _told(row), secret

    def known(self) -> list[ApiKey]:
        """Return every key, revoked ones too, oldest first."""
        with reading(self._engine) as session:
            rows = session.scalars(select(ApiKeyRow).order_by(ApiKeyRow.created_at, ApiKeyRow.id))
            return [_told(row) for row in rows]

    def revoke(self, key_id: str) -> ApiKey:
        """Let a key open no more, for good; one that was revoked before keeps the earlier moment.

        Raises
        ------
        KeyNotFound
        """
        with writing(self._engine) as session:
            row = session.get(ApiKeyRow, key_id, with_for_update=True)
            if row is None:
                raise KeyNotFound(f"no key has the id {key_id[:40]!r}; `faience key list` tells the ids")
            row.revoked_at = row.revoked_at or now()
            return _told(row)

    def active(self) -> tuple[ActiveKey, ...]:
        """Return the keys that open, for a guard's comparison."""
        columns = ApiKeyRow.id, ApiKeyRow.digest, ApiKeyRow.scope, ApiKeyRow.name
        with reading(self._engine) as session:
            rows = session.execute(select(*columns).where(ApiKeyRow.revoked_at.is_(None)))
            return tuple(
                ActiveKey(id=key_id, digest=digest, scope=Scope(scope), name=name)
                for key_id, digest, scope, name in rows
            )


def has_active_key(url: str) -> bool:
    """Return whether the library at a SQLAlchemy URL holds a key that opens; makes no library there."""
    address = make_url(url)
    if address.get_backend_name() == "sqlite" and not Path(address.database or "").is_file():
        return False
    engine = make_engine(url)
    try:
        # a library of a version before keys has no such table yet
        return inspect(engine).has_table(ApiKeyRow.__tablename__) and bool(Keys(engine).active())
    finally:
        engine.dispose()


def _checked(name: str) -> str:
    plain = name.strip()
    if not plain or len(plain) > NAME_LENGTH or not plain.isprintable():
        raise BadKeyName(
            f"the name of a key, such as 'loan desk', has 1 to {NAME_LENGTH} printable characters, "
            f"got {name[:40]!r}"
        )
    return plain


def _told(row: ApiKeyRow) -> ApiKey:
    return ApiKey(
        id=row.id,
        name=row.name,
        scope=Scope(row.scope),
        created_at=row.created_at,
        revoked_at=row.revoked_at,
    )
