"""Versions of Faience that never were: with fewer steps than this one, or with one more."""

import shutil
from pathlib import Path
from typing import Any

import pytest
import sqlalchemy as sa
from alembic.migration import MigrationContext
from alembic.operations import Operations
from sqlalchemy import Engine, text

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


def pretend_older(patch: pytest.MonkeyPatch, folder: Path, steps: int = 1) -> None:
    """Let this be a version that knows only the first steps."""
    versions = _copied(patch, folder)
    for path in _steps(versions)[steps:]:
        path.unlink()


def take_back_steps(engine: Engine) -> None:
    """Make a database what the first step made it."""
    with engine.begin() as connection:
        for table in ("api_keys", "dismissals", "tags", "finished_jobs", "renewals"):
            connection.execute(text(f"DROP TABLE {table}"))
        for column in ("queued_at", "claimed_at", "fingerprint"):
            connection.execute(text(f"ALTER TABLE jobs DROP COLUMN {column}"))
        connection.execute(text("ALTER TABLE shapes DROP COLUMN made_in"))
        _take_back_versions(Operations(MigrationContext.configure(connection)))
        connection.execute(text("UPDATE alembic_version SET version_num = '0001'"))


def _take_back_versions(op: Operations) -> None:
    with op.batch_alter_table("state") as state:
        state.drop_constraint("fk_state_next_vocabulary_id", type_="foreignkey")
        state.drop_column("next_vocabulary_id")
    earlier = op.create_table(
        "earlier_blocks",
        sa.Column("shape_id", sa.String(), nullable=False),
        sa.Column("name", sa.String(), nullable=False),
        sa.Column("data", sa.LargeBinary(), nullable=False),
    )
    columns: list[sa.ColumnClause[Any]] = [sa.column(name) for name in ("shape_id", "name", "data")]
    op.execute(
        sa.insert(earlier).from_select(columns, sa.select(*columns).select_from(sa.table("plain_blocks")))
    )
    op.drop_table("plain_blocks")
    op.rename_table("earlier_blocks", "plain_blocks")
    with op.batch_alter_table("plain_blocks") as blocks:
        blocks.create_primary_key("pk_plain_blocks", ["shape_id", "name"])
        blocks.create_foreign_key(
            "fk_plain_blocks_shape_id", "shapes", ["shape_id"], ["id"], ondelete="CASCADE"
        )


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
