"""Deliveries: what webhooks are still to be told, claimed so that one process at a time sends each."""

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import ColumnElement, Engine, Select, and_, delete, func, insert, literal, or_, select, update
from sqlalchemy.orm import InstrumentedAttribute, Session

from index.database import reading, writing
from index.revisions import now
from index.shapes import Status
from index.tables import DeliveryRow, ShapeRow, WebhookRow

FORGOTTEN = timedelta(days=3)  # after which nobody is told any more
SHORTEST, LONGEST = timedelta(seconds=5), timedelta(hours=1)  # rests after failures


@dataclass(frozen=True, kw_only=True)
class Delivery:
    """One message as its sender holds it."""

    id: int  # never given twice: a receiver knows by it what it was told before
    url: str
    secret: bytes
    shape_id: str
    status: Status  # that the shape came to
    happened_at: datetime


def announce(session: Session, shape_id: str, status: Status, moment: datetime) -> None:
    """Note for every webhook what a shape came to, in the transaction in which it does."""
    told = literal(shape_id), literal(str(status)), literal(moment, DeliveryRow.happened_at.type)
    columns = ["webhook_id", "shape_id", "status", "happened_at"]
    session.execute(insert(DeliveryRow).from_select(columns, select(WebhookRow.id, *told)))


class Deliveries:
    """What is to be told; each method is one transaction.

    Parameters
    ----------
    engine : Engine
        The catalogue's own.
    clock : callable
        Returns the present moment, aware.
    """

    def __init__(self, engine: Engine, clock: Callable[[], datetime] = now) -> None:
        self._engine, self._clock = engine, clock

    def claim(self, seconds: float) -> Delivery | None:
        """Take the oldest message that nobody sends, of a webhook that does not rest; None without any.

        Parameters
        ----------
        seconds : float
            After which another may take it.
        """
        moment = self._clock()
        with reading(self._engine) as session:  # asking again and again must not lock others out
            if session.scalars(_due(moment)).first() is None:
                return None
        with writing(self._engine) as session:
            _drop_stale(session, moment)
            taken = session.scalars(_due(moment).with_for_update(skip_locked=True, of=DeliveryRow)).first()
            if taken is None:
                return None
            row = session.get_one(DeliveryRow, taken)
            row.lease_until = moment + timedelta(seconds=seconds)
            return _held(row, session.get_one(WebhookRow, row.webhook_id))

    def told(self, delivery: Delivery) -> None:
        """Forget a message that arrived; its webhook needs no rest."""
        with writing(self._engine) as session:
            row = session.get(DeliveryRow, delivery.id)
            if row is None:  # another sender was quicker, or the shape is gone
                return
            awake = update(WebhookRow).where(WebhookRow.id == row.webhook_id)
            session.execute(awake.values(failures=0, failure=None, rests_until=None))
            session.delete(row)

    def drop(self, delivery: Delivery) -> None:
        """Forget a message that needs not be told."""
        with writing(self._engine) as session:
            session.execute(delete(DeliveryRow).where(DeliveryRow.id == delivery.id))

    def failed(self, delivery: Delivery, reason: str) -> None:
        """Let a webhook rest, the longer the more often it failed, and the message wait for it."""
        with writing(self._engine) as session:
            row = session.get(DeliveryRow, delivery.id)
            if row is None:
                return
            hook = session.get_one(WebhookRow, row.webhook_id, with_for_update=True)
            rest = min(SHORTEST * 2 ** min(hook.failures, 20), LONGEST)
            hook.failures, hook.failure = hook.failures + 1, reason
            hook.rests_until, row.lease_until = self._clock() + rest, None

    def waiting(self) -> int:
        """Return how many messages were not told yet."""
        with reading(self._engine) as session:
            return session.scalars(select(func.count()).select_from(DeliveryRow)).one()


def _due(moment: datetime) -> Select[int]:
    return (
        select(DeliveryRow.id)
        .join(WebhookRow, WebhookRow.id == DeliveryRow.webhook_id)
        .where(_past(DeliveryRow.lease_until, moment), _past(WebhookRow.rests_until, moment))
        .order_by(DeliveryRow.id)
        .limit(1)
    )


def _past(column: InstrumentedAttribute[datetime | None], moment: datetime) -> ColumnElement[bool]:
    return or_(column.is_(None), column <= moment)


def _drop_stale(session: Session, moment: datetime) -> None:
    """Forget what nobody could be told for days, and what is not true any more: the next message is."""
    other = select(ShapeRow.id).where(
        and_(ShapeRow.id == DeliveryRow.shape_id, ShapeRow.status != DeliveryRow.status)
    )
    old = DeliveryRow.happened_at < moment - FORGOTTEN
    session.execute(
        delete(DeliveryRow).where(or_(old, other.exists())).execution_options(synchronize_session=False)
    )


def _held(row: DeliveryRow, hook: WebhookRow) -> Delivery:
    return Delivery(
        id=row.id,
        url=hook.url,
        secret=hook.secret,
        shape_id=row.shape_id,
        status=Status(row.status),
        happened_at=row.happened_at,
    )
