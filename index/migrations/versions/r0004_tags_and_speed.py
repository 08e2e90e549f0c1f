"""Tags, taken from metadata; when jobs were queued and claimed, and how those went that ended lately."""

import json
from collections.abc import Iterator
from typing import Any

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"
branch_labels = None
depends_on = None

LONGEST, MOST = 200, 100  # characters of a tag, tags of a shape


def upgrade() -> None:
    """Make the tables, and fill that of tags."""
    op.add_column("jobs", sa.Column("queued_at", sa.DateTime(), nullable=True))
    op.add_column("jobs", sa.Column("claimed_at", sa.DateTime(), nullable=True))
    _create_finished_jobs()
    tags = op.create_table(
        "tags",
        sa.Column("shape_id", sa.String(), nullable=False),
        sa.Column("folded", sa.String(), nullable=False),
        sa.Column("shown", sa.String(), nullable=False),
        sa.ForeignKeyConstraint(["shape_id"], ["shapes.id"], name="fk_tags_shape_id", ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("shape_id", "folded", name="pk_tags"),
    )
    op.create_index("ix_tags_folded", "tags", ["folded"])
    shapes = sa.table("shapes", sa.column("id", sa.String()), sa.column("metadata", sa.JSON()))
    found = op.get_bind().execute(sa.select(shapes.c.id, shapes.c.metadata)).all()
    rows = [row for shape_id, metadata in found for row in _tags_of(shape_id, metadata)]
    if rows:
        op.bulk_insert(tags, rows)


def _create_finished_jobs() -> None:
    integer = sa.BigInteger().with_variant(sa.Integer(), "sqlite")
    op.create_table(
        "finished_jobs",
        sa.Column("id", integer, nullable=False),
        sa.Column("finished_at", sa.DateTime(), nullable=False),
        sa.Column("seconds", sa.Double(), nullable=False),
        sa.Column("outcome", sa.String(), nullable=False),
        sa.Column("worker", sa.String(), nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_finished_jobs"),
    )
    op.create_index("ix_finished_jobs_finished_at", "finished_jobs", ["finished_at"])


def _tags_of(shape_id: str, metadata: Any) -> Iterator[dict[str, str]]:
    """Yield rows as `index.tags` made them when this step was written."""
    kept = json.loads(metadata) if isinstance(metadata, str) else metadata
    given = kept.get("tags") if isinstance(kept, dict) else None
    known: dict[str, str] = {}
    for tag in [given] if isinstance(given, str) else given if isinstance(given, list) else []:
        shown = " ".join(_storable(tag).split()) if isinstance(tag, str) else ""
        if shown and len(shown) <= LONGEST:
            known.setdefault(shown.casefold(), shown)
    for folded, shown in list(known.items())[:MOST]:
        yield {"shape_id": shape_id, "folded": folded, "shown": shown}


def _storable(text: str) -> str:
    return text.encode("utf-8", "replace").decode().replace("\0", " ")
