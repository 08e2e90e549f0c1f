"""Versions of Faience that never were: with fewer steps than this one, or with one more."""

import shutil
from pathlib import Path

import pytest
from sqlalchemy import text

from index import migrating
from index.database import make_engine

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


def pretend_newer(patch: pytest.MonkeyPatch, folder: Path, body: str = INITIALS) -> None:
    """Let this be a version with one step more."""
    versions = _copied(patch, folder)
    newest = _steps(versions)[-1].name.split("_")[0].removeprefix("r")
    (versions / "r9999_made.py").write_text(STEP.format(newest=newest, body=body))


def migrated_library(url: str) -> str:
    """Migrate a database; return the name of its library."""
    engine = make_engine(url)
    migrating.migrate(engine)
    with engine.connect() as connection:
        library: str = connection.scalar(text("SELECT library FROM state"))
    engine.dispose()
    return library


def migrate_with(scripts: Path, url: str) -> None:
    """Migrate a database by the steps of a folder."""
    migrating.SCRIPTS = scripts
    migrating.migrate(make_engine(url))


def _copied(patch: pytest.MonkeyPatch, folder: Path) -> Path:
    copy = folder / "migrations"
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(Path(migrating.__file__).parent / "migrations", copy, ignore=ignored)
    patch.setattr(migrating, "SCRIPTS", copy)
    return copy / "versions"


def _steps(versions: Path) -> list[Path]:
    return sorted(versions.glob("r*.py"))
