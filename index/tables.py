"""The tables, as SQLAlchemy maps them. `migrations` must lead to exactly these."""

from datetime import UTC, datetime
from typing import Any

from sqlalchemy import (
    JSON,
    BigInteger,
    CheckConstraint,
    DateTime,
    Dialect,
    ForeignKey,
    Integer,
    LargeBinary,
    MetaData,
    TypeDecorator,
)
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column, relationship

_NAMES = {  # fixed names, so that later migrations can name what they change
    "ix": "ix_%(table_name)s_%(column_0_name)s",
    "uq": "uq_%(table_name)s_%(column_0_name)s",
    "fk": "fk_%(table_name)s_%(column_0_name)s",
    "pk": "pk_%(table_name)s",
    "ck": "ck_%(table_name)s_%(constraint_name)s",
}


class UtcDateTime(TypeDecorator[datetime]):
    """A moment, aware in Python and UTC in the database (SQLite keeps no offset)."""

    impl = DateTime
    cache_ok = True

    def process_bind_param(self, value: datetime | None, dialect: Dialect) -> datetime | None:  # noqa: ARG002 - SQLAlchemy's signature
        """Aware → naive UTC."""
        return None if value is None else value.astimezone(UTC).replace(tzinfo=None)

    def process_result_value(self, value: datetime | None, dialect: Dialect) -> datetime | None:  # noqa: ARG002 - SQLAlchemy's signature
        """Naive UTC → aware."""
        return None if value is None else value.replace(tzinfo=UTC)


class Base(DeclarativeBase):
    """The root of the mapped classes."""

    metadata = MetaData(naming_convention=_NAMES)
    type_annotation_map = {  # noqa: RUF012 - SQLAlchemy's way to say it
        dict[str, Any]: JSON(none_as_null=True),
        datetime: UtcDateTime(),
        bytes: LargeBinary(),
        int: BigInteger().with_variant(Integer(), "sqlite"),  # there every integer has 64 bits
    }


class StateRow(Base):
    """The one row that every change goes through, which also puts the writers in order."""

    __tablename__ = "state"

    id: Mapped[int] = mapped_column(primary_key=True)  # always 1
    library: Mapped[str]  # random, made with the catalogue
    revision: Mapped[int]  # of the last change
    epoch: Mapped[int]  # raised when every index must be built anew
    vocabulary_id: Mapped[str | None] = mapped_column(ForeignKey("vocabularies.id"))  # the active one
    next_vocabulary_id: Mapped[str | None] = mapped_column(  # active when all is described anew; see renewals
        ForeignKey("vocabularies.id")
    )


class ShapeRow(Base):
    """One shape."""

    __tablename__ = "shapes"

    id: Mapped[str] = mapped_column(primary_key=True)
    name: Mapped[str]
    status: Mapped[str] = mapped_column(index=True)
    created_at: Mapped[datetime]
    updated_at: Mapped[datetime]
    user_metadata: Mapped[dict[str, Any]] = mapped_column("metadata")  # the bare name is SQLAlchemy's
    sha256: Mapped[str] = mapped_column(unique=True)
    revision: Mapped[int] = mapped_column(index=True)  # of its last change
    sequence: Mapped[int] = mapped_column(unique=True)  # revision of its acceptance: orders the list
    searchable: Mapped[str]  # name and metadata values, case-folded
    allow_untextured: Mapped[bool]
    facts: Mapped[dict[str, Any] | None]
    fingerprint: Mapped[str | None]  # of the parameters that made its blocks
    made_in: Mapped[str | None]  # folder of the files made of it; None: none of its own
    error_code: Mapped[str | None]
    error_detail: Mapped[str | None]
    files: Mapped[list["FileRow"]] = relationship(
        order_by="FileRow.position", cascade="all, delete-orphan", passive_deletes=True, lazy="selectin"
    )


class FileRow(Base):
    """One uploaded file of a shape."""

    __tablename__ = "files"

    shape_id: Mapped[str] = mapped_column(ForeignKey("shapes.id", ondelete="CASCADE"), primary_key=True)
    position: Mapped[int] = mapped_column(primary_key=True)  # order of the upload
    name: Mapped[str]
    key: Mapped[str]
    size: Mapped[int]
    sha256: Mapped[str]


class TagRow(Base):
    """A tag of a shape, taken from its metadata, so that shapes are found by it."""

    __tablename__ = "tags"

    shape_id: Mapped[str] = mapped_column(ForeignKey("shapes.id", ondelete="CASCADE"), primary_key=True)
    folded: Mapped[str] = mapped_column(primary_key=True, index=True)  # what is compared
    shown: Mapped[str]  # as it was written


class JobRow(Base):
    """Work to be done on a shape; the row is gone when it is done."""

    __tablename__ = "jobs"
    __table_args__ = ({"sqlite_autoincrement": True},)  # an id is never given twice

    id: Mapped[int] = mapped_column(primary_key=True)  # oldest first
    shape_id: Mapped[str] = mapped_column(ForeignKey("shapes.id", ondelete="CASCADE"), unique=True)
    attempts: Mapped[int]  # claims so far
    lease_until: Mapped[datetime | None]  # None while nobody has it
    worker: Mapped[str | None]
    token: Mapped[str | None]  # random for each claim: tells the holder from an earlier one
    queued_at: Mapped[datetime | None]  # None where an earlier version queued it
    claimed_at: Mapped[datetime | None]  # None while nobody has it
    fingerprint: Mapped[str | None]  # of the parameters to describe a ready shape anew with; None: an upload


class FinishedJobRow(Base):
    """A job that ended lately: how fast the workers are. It is no part of what a library keeps."""

    __tablename__ = "finished_jobs"

    id: Mapped[int] = mapped_column(primary_key=True)
    finished_at: Mapped[datetime] = mapped_column(index=True)
    seconds: Mapped[float]  # since it was claimed
    outcome: Mapped[str]  # `ready`, or the code of the failure
    worker: Mapped[str]


class VocabularyRow(Base):
    """A vocabulary; `state` names the active one."""

    __tablename__ = "vocabularies"

    id: Mapped[str] = mapped_column(primary_key=True)
    fingerprint: Mapped[str]
    data: Mapped[bytes]
    created_at: Mapped[datetime]


class PlainBlockRow(Base):
    """A descriptor block that needs no vocabulary."""

    __tablename__ = "plain_blocks"

    shape_id: Mapped[str] = mapped_column(ForeignKey("shapes.id", ondelete="CASCADE"), primary_key=True)
    fingerprint: Mapped[str] = mapped_column(primary_key=True, index=True)  # of the parameters that made it
    name: Mapped[str] = mapped_column(primary_key=True)
    data: Mapped[bytes]  # see index.blocks


class QuantisedBlockRow(Base):
    """A descriptor block in the words of one vocabulary."""

    __tablename__ = "quantised_blocks"

    shape_id: Mapped[str] = mapped_column(ForeignKey("shapes.id", ondelete="CASCADE"), primary_key=True)
    vocabulary_id: Mapped[str] = mapped_column(ForeignKey("vocabularies.id"), primary_key=True)
    name: Mapped[str] = mapped_column(primary_key=True)
    data: Mapped[bytes]


class RenewalRow(Base):
    """What came of describing a ready shape anew; it answers with its earlier description until all are."""

    __tablename__ = "renewals"

    shape_id: Mapped[str] = mapped_column(ForeignKey("shapes.id", ondelete="CASCADE"), primary_key=True)
    fingerprint: Mapped[str] = mapped_column(primary_key=True, index=True)
    facts: Mapped[dict[str, Any] | None]  # None where it failed
    error_code: Mapped[str | None]
    error_detail: Mapped[str | None]


class TombstoneRow(Base):
    """A shape that was removed, so that indexes and watchers hear of it."""

    __tablename__ = "tombstones"

    shape_id: Mapped[str] = mapped_column(primary_key=True)
    revision: Mapped[int] = mapped_column(index=True)


class ApiKeyRow(Base):
    """Who may use the library over HTTP; a revoked key stays, so that the list tells of it."""

    __tablename__ = "api_keys"

    id: Mapped[str] = mapped_column(primary_key=True)  # public, part of the key
    name: Mapped[str]  # whose it is, for people
    digest: Mapped[bytes]  # SHA-256 of the key, which itself is kept nowhere
    scope: Mapped[str]
    created_at: Mapped[datetime]
    revoked_at: Mapped[datetime | None]


class DismissalRow(Base):
    """A pair of shapes that somebody said are no duplicates; the lesser id is the first."""

    __tablename__ = "dismissals"
    __table_args__ = (CheckConstraint("one < other", name="ordered"),)

    one: Mapped[str] = mapped_column(ForeignKey("shapes.id", ondelete="CASCADE"), primary_key=True)
    other: Mapped[str] = mapped_column(
        ForeignKey("shapes.id", ondelete="CASCADE"), primary_key=True, index=True
    )
    created_at: Mapped[datetime]


class WebhookRow(Base):
    """An address that is told when a shape is ready or failed."""

    __tablename__ = "webhooks"

    id: Mapped[str] = mapped_column(primary_key=True)
    url: Mapped[str]
    secret: Mapped[bytes]  # signs what is sent, so it is kept as it is
    created_at: Mapped[datetime]
    failures: Mapped[int]  # in a row
    failure: Mapped[str | None]  # the last of them, in words
    rests_until: Mapped[datetime | None]  # after a failure


class DeliveryRow(Base):
    """What a webhook was not told yet; the row is gone when it was."""

    __tablename__ = "deliveries"
    __table_args__ = ({"sqlite_autoincrement": True},)  # receivers know a message by its number

    id: Mapped[int] = mapped_column(primary_key=True)  # oldest first
    webhook_id: Mapped[str] = mapped_column(ForeignKey("webhooks.id", ondelete="CASCADE"), index=True)
    shape_id: Mapped[str] = mapped_column(ForeignKey("shapes.id", ondelete="CASCADE"), index=True)
    status: Mapped[str]  # that the shape came to
    happened_at: Mapped[datetime]
    lease_until: Mapped[datetime | None]  # None while nobody sends it
