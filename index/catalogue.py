"""Catalogue: the truth about what a library holds. One method is one transaction."""

from sqlalchemy import Engine

from index.acceptance import Acceptance
from index.descriptions import Descriptions
from index.dismissals import Dismissals
from index.editing import Editing
from index.listing import Listing
from index.progress import Progress
from index.questions import Questions
from index.renewals import Renewals
from index.revisions import Revisions
from index.stored_blocks import StoredBlocks
from index.stored_vocabularies import Vocabularies
from index.tags import Tags


class Catalogue(
    Acceptance,
    Editing,
    Descriptions,
    Revisions,
    StoredBlocks,
    Vocabularies,
    Renewals,
    Listing,
    Questions,
    Dismissals,
    Tags,
    Progress,
):
    """Shapes, their descriptors and vocabularies; each of the classes above is one of its concerns.

    Safe to share between threads; other processes may have their own on the same database.

    Parameters
    ----------
    engine : Engine
        From `index.database.make_engine`, with a schema that `migrate` brought up to date.
    """

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
