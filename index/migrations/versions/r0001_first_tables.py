"""The first tables: shapes and their files, jobs, blocks, vocabularies, the state."""

from uuid import uuid4

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Make every table, and the one row of the state."""
    _create_vocabularies()
    _create_shapes()
    _create_files()
    _create_jobs()
    _create_blocks()
    _create_tombstones()
    _create_state()


def _integer() -> sa.BigInteger:
    return sa.BigInteger().with_variant(sa.Integer(), "sqlite")


def _json() -> sa.JSON:
    return sa.JSON(none_as_null=True)


def _shape_key(table: str) -> sa.ForeignKeyConstraint:
    name = f"fk_{table}_shape_id"
    return sa.ForeignKeyConstraint(["shape_id"], ["shapes.id"], name=name, ondelete="CASCADE")


def _create_vocabularies() -> None:
    op.create_table(
        "vocabularies",
        sa.Column("id", sa.String(), nullable=False),
        sa.Column("fingerprint", sa.String(), nullable=False),
        sa.Column("data", sa.LargeBinary(), nullable=False),
        sa.Column("created_at", sa.DateTime(), nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_vocabularies"),
    )


def _create_shapes() -> None:
    op.create_table(
        "shapes",
        sa.Column("id", sa.String(), nullable=False),
        sa.Column("name", sa.String(), nullable=False),
        sa.Column("status", sa.String(), nullable=False),
        sa.Column("created_at", sa.DateTime(), nullable=False),
        sa.Column("updated_at", sa.DateTime(), nullable=False),
        sa.Column("metadata", _json(), nullable=False),
        sa.Column("sha256", sa.String(), nullable=False),
        sa.Column("revision", _integer(), nullable=False),
        sa.Column("sequence", _integer(), nullable=False),
        sa.Column("searchable", sa.String(), nullable=False),
        sa.Column("allow_untextured", sa.Boolean(), nullable=False),
        sa.Column("facts", _json(), nullable=True),
        sa.Column("fingerprint", sa.String(), nullable=True),
        sa.Column("error_code", sa.String(), nullable=True),
        sa.Column("error_detail", sa.String(), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_shapes"),
        sa.UniqueConstraint("sha256", name="uq_shapes_sha256"),
        sa.UniqueConstraint("sequence", name="uq_shapes_sequence"),
    )
    op.create_index("ix_shapes_status", "shapes", ["status"])
    op.create_index("ix_shapes_revision", "shapes", ["revision"])


def _create_files() -> None:
    op.create_table(
        "files",
        sa.Column("shape_id", sa.String(), nullable=False),
        sa.Column("position", _integer(), nullable=False),
        sa.Column("name", sa.String(), nullable=False),
        sa.Column("key", sa.String(), nullable=False),
        sa.Column("size", _integer(), nullable=False),
        sa.Column("sha256", sa.String(), nullable=False),
        _shape_key("files"),
        sa.PrimaryKeyConstraint("shape_id", "position", name="pk_files"),
    )


def _create_jobs() -> None:
    op.create_table(
        "jobs",
        sa.Column("id", _integer(), nullable=False),
        sa.Column("shape_id", sa.String(), nullable=False),
        sa.Column("attempts", _integer(), nullable=False),
        sa.Column("lease_until", sa.DateTime(), nullable=True),
        sa.Column("worker", sa.String(), nullable=True),
        sa.Column("token", sa.String(), nullable=True),
        _shape_key("jobs"),
        sa.PrimaryKeyConstraint("id", name="pk_jobs"),
        sa.UniqueConstraint("shape_id", name="uq_jobs_shape_id"),
        sqlite_autoincrement=True,
    )


def _create_blocks() -> None:
    op.create_table(
        "plain_blocks",
        sa.Column("shape_id", sa.String(), nullable=False),
        sa.Column("name", sa.String(), nullable=False),
        sa.Column("data", sa.LargeBinary(), nullable=False),
        _shape_key("plain_blocks"),
        sa.PrimaryKeyConstraint("shape_id", "name", name="pk_plain_blocks"),
    )
    op.create_table(
        "quantised_blocks",
        sa.Column("shape_id", sa.String(), nullable=False),
        sa.Column("vocabulary_id", sa.String(), nullable=False),
        sa.Column("name", sa.String(), nullable=False),
        sa.Column("data", sa.LargeBinary(), nullable=False),
        _shape_key("quantised_blocks"),
        sa.ForeignKeyConstraint(
            ["vocabulary_id"], ["vocabularies.id"], name="fk_quantised_blocks_vocabulary_id"
        ),
        sa.PrimaryKeyConstraint("shape_id", "vocabulary_id", "name", name="pk_quantised_blocks"),
    )


def _create_tombstones() -> None:
    op.create_table(
        "tombstones",
        sa.Column("shape_id", sa.String(), nullable=False),
        sa.Column("revision", _integer(), nullable=False),
        sa.PrimaryKeyConstraint("shape_id", name="pk_tombstones"),
    )
    op.create_index("ix_tombstones_revision", "tombstones", ["revision"])


def _create_state() -> None:
    state = op.create_table(
        "state",
        sa.Column("id", _integer(), nullable=False),
        sa.Column("library", sa.String(), nullable=False),
        sa.Column("revision", _integer(), nullable=False),
        sa.Column("epoch", _integer(), nullable=False),
        sa.Column("vocabulary_id", sa.String(), nullable=True),
        sa.ForeignKeyConstraint(["vocabulary_id"], ["vocabularies.id"], name="fk_state_vocabulary_id"),
        sa.PrimaryKeyConstraint("id", name="pk_state"),
    )
    first = {"id": 1, "library": uuid4().hex, "revision": 0, "epoch": 1, "vocabulary_id": None}
    op.bulk_insert(state, [first])
