"""Versions of Faience that never were: with fewer steps than this one, or with one more."""

import shutil
from pathlib import Path

import pytest
from sqlalchemy import Engine, text

from index import migrating

STEP = '''"""A step that was never made."""

import sqlalchemy as sa
from alembic import op

revision = "made"
down_revision = "{newest}"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Apply this step."""
{body}
'''

# Makes the table of shapes anew and fills a new column from an old one.
INITIALS = """
    with op.batch_alter_table("shapes", recreate="always") as shapes:
        shapes.add_column(sa.Column("initial", sa.String(), nullable=False, server_default="?"))
    op.execute("UPDATE shapes SET initial = substr(name, 1, 1)")
"""

# Adds what people decide about shapes, and who agrees.
DECISIONS = """
    op.create_table(
        "decisions",
        sa.Column("id", sa.Integer(), primary_key=True),
        sa.Column("shape_id", sa.String(), sa.ForeignKey("shapes.id", ondelete="CASCADE"), nullable=False),
        sa.Column("verdict", sa.JSON(), nullable=True),
        sa.Column("weight", sa.Float(), nullable=False),
    )
    op.create_table(
        "agreements",
        sa.Column("decision_id", sa.Integer(), sa.ForeignKey("decisions.id", ondelete="CASCADE")),
        sa.Column("who", sa.String(), nullable=False),
    )
"""


def pretend_older(patch: pytest.MonkeyPatch, folder: Path, steps: int = 1) -> None:
    """Let this be a version that knows only the first steps."""
    versions = _copied(patch, folder)
    for path in _steps(versions)[steps:]:
        path.unlink()


def take_back_steps(engine: Engine) -> None:
    """Make a database what the first step made it."""
    with engine.begin() as connection:
        for table in ("api_keys", "dismissals", "tags", "finished_jobs", "deliveries", "webhooks"):
            connection.execute(text(f"DROP TABLE {table}"))
        for column in ("queued_at", "claimed_at"):
            connection.execute(text(f"ALTER TABLE jobs DROP COLUMN {column}"))
        connection.execute(text("UPDATE alembic_version SET version_num = '0001'"))


def pretend_newer(patch: pytest.MonkeyPatch, folder: Path, body: str = INITIALS) -> None:
    """Let this be a version with one step more."""
    versions = _copied(patch, folder)
    newest = _steps(versions)[-1].name.split("_")[0].removeprefix("r")
    (versions / "r9999_made.py").write_text(STEP.format(newest=newest, body=body))


def _copied(patch: pytest.MonkeyPatch, folder: Path) -> Path:
    copy = folder / "migrations"
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(Path(migrating.__file__).parent / "migrations", copy, ignore=ignored)
    patch.setattr(migrating, "SCRIPTS", copy)
    return copy / "versions"


def _steps(versions: Path) -> list[Path]:
    return sorted(versions.glob("r*.py"))
