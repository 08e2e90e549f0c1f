"""Descriptions of two versions beside each other, so that a new one replaces the old for all at once."""

import sqlalchemy as sa
from alembic import op

revision = "0006"
down_revision = "0005"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Tell blocks of different parameters apart, and make the table of what was described anew."""
    op.add_column("shapes", sa.Column("made_in", sa.String(), nullable=True))
    op.add_column("jobs", sa.Column("fingerprint", sa.String(), nullable=True))
    with op.batch_alter_table("state") as state:
        state.add_column(sa.Column("next_vocabulary_id", sa.String(), nullable=True))
        state.create_foreign_key(
            "fk_state_next_vocabulary_id", "vocabularies", ["next_vocabulary_id"], ["id"]
        )
    if op.get_bind().dialect.name == "sqlite":
        _copy_blocks()
    else:
        _alter_blocks()
    op.create_index("ix_plain_blocks_fingerprint", "plain_blocks", ["fingerprint"])
    _create_renewals()


def _copy_blocks() -> None:
    """Make the table of blocks anew: SQLite cannot change a primary key."""
    op.create_table(
        "plain_blocks_anew",
        sa.Column("shape_id", sa.String(), nullable=False),
        sa.Column("fingerprint", sa.String(), nullable=False),
        sa.Column("name", sa.String(), nullable=False),
        sa.Column("data", sa.LargeBinary(), nullable=False),
        sa.ForeignKeyConstraint(
            ["shape_id"], ["shapes.id"], name="fk_plain_blocks_shape_id", ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("shape_id", "fingerprint", "name", name="pk_plain_blocks"),
    )
    op.execute(
        "INSERT INTO plain_blocks_anew (shape_id, fingerprint, name, data)"
        " SELECT b.shape_id, COALESCE(s.fingerprint, ''), b.name, b.data"
        " FROM plain_blocks AS b JOIN shapes AS s ON s.id = b.shape_id ORDER BY b.shape_id, b.name"
    )
    op.drop_table("plain_blocks")
    op.rename_table("plain_blocks_anew", "plain_blocks")


def _alter_blocks() -> None:
    op.add_column("plain_blocks", sa.Column("fingerprint", sa.String(), nullable=True))
    op.execute(
        "UPDATE plain_blocks SET fingerprint = COALESCE(s.fingerprint, '')"
        " FROM shapes AS s WHERE s.id = plain_blocks.shape_id"
    )
    op.alter_column("plain_blocks", "fingerprint", nullable=False)
    op.drop_constraint("pk_plain_blocks", "plain_blocks")
    op.create_primary_key("pk_plain_blocks", "plain_blocks", ["shape_id", "fingerprint", "name"])


def _create_renewals() -> None:
    op.create_table(
        "renewals",
        sa.Column("shape_id", sa.String(), nullable=False),
        sa.Column("fingerprint", sa.String(), nullable=False),
        sa.Column("facts", sa.JSON(), nullable=True),
        sa.Column("error_code", sa.String(), nullable=True),
        sa.Column("error_detail", sa.String(), nullable=True),
        sa.ForeignKeyConstraint(["shape_id"], ["shapes.id"], name="fk_renewals_shape_id", ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("shape_id", "fingerprint", name="pk_renewals"),
    )
    op.create_index("ix_renewals_fingerprint", "renewals", ["fingerprint"])
