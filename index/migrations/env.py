"""What Alembic runs; `index.database.migrate` hands it the connection."""

from alembic import context

from index.tables import Base

context.configure(
    connection=context.config.attributes["connection"],
    target_metadata=Base.metadata,
    render_as_batch=True,  # SQLite cannot alter a column in place
)
context.run_migrations()
