"""Upcoming: the catalogue as it is in the words of the next vocabulary, while shapes are described anew."""

from collections.abc import Collection, Iterator
from dataclasses import replace

from index.catalogue import Catalogue
from index.shapes import CatalogueState
from index.stored_blocks import Blocks


class Upcoming(Catalogue):
    """What a `Searcher` needs to rank the shapes that are described anew already; it holds no others."""

    def state(self) -> CatalogueState:
        """Return a state of its own line: an index of it is never taken for one of the active vocabulary."""
        state = super().state()
        upcoming = state.next_vocabulary_id
        return replace(
            state,
            library=f"{state.library} in {upcoming}",
            vocabulary_id=upcoming,
            next_vocabulary_id=None,
        )

    def block_rows(
        self,
        vocabulary_id: str | None,
        after_revision: int = 0,
        names: Collection[str] | None = None,
        but: Collection[str] = (),
    ) -> Iterator[tuple[str, Blocks]]:
        """Do as the catalogue does; nothing while no vocabulary is the next."""
        if vocabulary_id is not None:
            yield from super().block_rows(vocabulary_id, after_revision, names, but)
