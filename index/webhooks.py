"""The webhooks of a library: who is told that a shape is ready or failed."""

import secrets
from dataclasses import dataclass
from datetime import datetime
from urllib.parse import urlsplit

from sqlalchemy import Engine, select

from index.database import reading, writing
from index.errors import BadWebhook, WebhookNotFound
from index.revisions import now
from index.tables import WebhookRow

ID_BYTES = 5
SECRET_BYTES = 32  # the Standard Webhooks specification asks for 24 to 64
LONGEST = 2000  # characters of an address


@dataclass(frozen=True, kw_only=True)
class Webhook:
    """What may be told about a webhook."""

    id: str
    url: str
    created_at: datetime  # UTC
    failures: int  # in a row
    failure: str | None  # the last of them, in words
    rests_until: datetime | None  # UTC; after a failure


class Webhooks:
    """The webhooks of one library; each method is one transaction.

    Parameters
    ----------
    engine : Engine
        From `index.database.make_engine`, with a schema that `migrate` brought up to date.
    """

    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    def add(self, url: str) -> tuple[Webhook, bytes]:
        """Tell an address of what happens from now on.

        Returns
        -------
        Webhook, bytes
            And the secret by which the receiver knows that it was us.

        Raises
        ------
        BadWebhook
        """
        row = WebhookRow(
            id=secrets.token_hex(ID_BYTES),
            url=_checked(url),
            secret=secrets.token_bytes(SECRET_BYTES),
            created_at=now(),
            failures=0,
        )
        with writing(self._engine) as session:
            session.add(row)
            session.flush()
            return _told(row), row.secret

    def known(self) -> list[Webhook]:
        """Return every webhook, oldest first."""
        with reading(self._engine) as session:
            rows = session.scalars(select(WebhookRow).order_by(WebhookRow.created_at, WebhookRow.id))
            return [_told(row) for row in rows]

    def address(self, webhook_id: str) -> tuple[str, bytes]:
        """Return where a webhook is told, and its secret; WebhookNotFound where there is none."""
        with reading(self._engine) as session:
            row = _found(session.get(WebhookRow, webhook_id), webhook_id)
            return row.url, row.secret

    def remove(self, webhook_id: str) -> None:
        """Tell an address nothing any more; WebhookNotFound where there is none."""
        with writing(self._engine) as session:
            session.delete(_found(session.get(WebhookRow, webhook_id), webhook_id))


def _found(row: WebhookRow | None, webhook_id: str) -> WebhookRow:
    if row is None:
        raise WebhookNotFound(
            f"no webhook has the id {webhook_id[:40]!r}; `faience webhook list` tells the ids"
        )
    return row


def _checked(url: str) -> str:
    try:
        parts = urlsplit(url)
        good = parts.scheme in ("http", "https") and bool(parts.hostname) and (parts.port or 1) > 0
    except ValueError:  # brackets without an end, a port that is no number
        good = False
    if not good or len(url) > LONGEST or not url.isprintable() or " " in url:
        raise BadWebhook(f"a webhook is an address such as https://library.example/faience, got {url[:80]!r}")
    return url


def _told(row: WebhookRow) -> Webhook:
    return Webhook(
        id=row.id,
        url=row.url,
        created_at=row.created_at,
        failures=row.failures,
        failure=row.failure,
        rests_until=row.rests_until,
    )
