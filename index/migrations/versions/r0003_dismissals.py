"""Dismissals: pairs of shapes that somebody said are no duplicates."""

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Make the table of dismissed pairs, empty."""
    op.create_table(
        "dismissals",
        sa.Column("one", sa.String(), nullable=False),
        sa.Column("other", sa.String(), nullable=False),
        sa.Column("created_at", sa.DateTime(), nullable=False),
        sa.CheckConstraint("one < other", name=op.f("ck_dismissals_ordered")),
        sa.ForeignKeyConstraint(["one"], ["shapes.id"], name="fk_dismissals_one", ondelete="CASCADE"),
        sa.ForeignKeyConstraint(["other"], ["shapes.id"], name="fk_dismissals_other", ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("one", "other", name="pk_dismissals"),
    )
    op.create_index("ix_dismissals_other", "dismissals", ["other"])
