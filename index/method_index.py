"""MethodIndex: the vectors of one method, kept in step with the catalogue."""

import logging
from collections.abc import Collection, Iterator, Mapping
from threading import Lock

import numpy.typing as npt

from index.catalogue import Catalogue
from index.errors import DamagedIndex, StorageFull, VocabularyChanged
from index.gathering import Gathered, gather, put_all
from index.index_file import Header, load_index, save_index
from index.layout import Layout
from index.local_files import LocalFiles
from index.locks import SharedLock
from index.methods import Method
from index.ranking import Ranked, rank
from index.shapes import CatalogueState
from index.vectors import GONE, Vectors

_log = logging.getLogger(__name__)


class MethodIndex:
    """A view of the catalogue that ranks by one method.

    Parameters
    ----------
    method : Method
        From the table, with its own weights.
    catalogue : Catalogue
        The truth.
    store : LocalFiles
        Where the view is kept between runs.
    """

    def __init__(self, method: Method, catalogue: Catalogue, store: LocalFiles) -> None:
        self.escalations = 0  # bounds in memory always prove the answer
        self._method = method
        self._names = [block.name for block in method.blocks]
        self._catalogue = catalogue
        self._store = store
        self._key = f"{method.name}.vectors"
        self._updating = Lock()  # one thread brings the view up to date, the others wait for it
        self._guard = SharedLock()  # of the next two, and of what the vectors hold
        self._vectors: Vectors | None = None  # None while no shape has all the blocks
        self._state: CatalogueState | None = None  # what the view shows at least; None before the first time
        self._saved: CatalogueState | None = None  # what the file shows

    @property
    def revision(self) -> int | None:
        """Which revision of the catalogue the view shows at least; None before it was asked for."""
        state = self._state
        return None if state is None else state.revision

    def catch_up(self) -> None:
        """Bring the view to what the catalogue is now; one cheap SELECT where nothing is new."""
        wanted = self._catalogue.state()
        if self._shows(wanted, wanted.revision):
            return
        with self._updating:
            current = wanted
            while not self._shows(current, wanted.revision):
                self._follow(current)
                current = self._catalogue.state()  # another vocabulary may have come meanwhile

    def rank(
        self,
        method: Method,
        blocks: Mapping[str, npt.ArrayLike],
        limit: int,
        exclude: Collection[str],
        vocabulary_id: str | None,
    ) -> Ranked:
        """Return the nearest shapes; see `index.ranking.rank` and `index.searcher.Searcher.search`."""
        with self._guard.shared():
            active = self._state.vocabulary_id if self._state else None
            if vocabulary_id not in (None, active):
                raise VocabularyChanged(f"the active vocabulary is {active}, not {vocabulary_id}")
            if self._vectors is None:
                return []
            return rank(self._vectors, self._vectors.layout.join(blocks), limit, exclude, method)

    def proves(self, method: Method, limit: int) -> bool:  # noqa: ARG002 - as all views are asked
        """Whether answers to such a question are proven to be complete: always."""
        return True

    def save(self) -> None:
        """Keep the view for the next run; nothing happens where the file already shows it."""
        with self._updating:  # nobody changes the vectors meanwhile; searches go on
            self._save()

    def _shows(self, state: CatalogueState, revision: int) -> bool:
        mine = self._state
        return mine is not None and _same_line(mine, state) and mine.revision >= revision

    def _follow(self, state: CatalogueState) -> None:
        mine = self._state
        if self._vectors is not None and mine is not None and _same_line(mine, state):
            self._apply_changes(self._vectors, mine.revision, state)
        else:
            self._replace(state)

    def _apply_changes(self, vectors: Vectors, revision: int, state: CatalogueState) -> None:
        changes = self._catalogue.changes_since(revision)
        gone = {*changes.changed, *changes.removed}
        for _, ids, rows in self._gather(state, revision):
            with self._guard.alone():  # for one piece: searches go on in between
                vectors.put(ids, rows)
            gone.difference_update(ids)
        if self._holds(state):
            with self._guard.alone():
                vectors.remove(gone)
                vectors.settle()
                self._state = state

    def _replace(self, state: CatalogueState) -> None:
        loaded = self._load(state) if self._state is None else None
        vectors = put_all(self._gather(state)) if loaded is None else loaded
        if self._holds(state):
            with self._guard.alone():
                self._vectors, self._state = vectors, state
            if loaded is None:
                self._save_if_possible()

    def _load(self, state: CatalogueState) -> Vectors | None:
        """Return what the file holds and is still true, completed; None where it cannot be used."""
        if not self._store.path(self._key).exists():
            return None
        revisions = self._catalogue.ready_revisions()
        try:
            header, arrays = load_index(self._store.path(self._key))
        except DamagedIndex as error:
            _log.info("the index of %s is built anew: %s", self._method.name, error)
            return None
        if not self._fits(header, state):
            return None
        layout = Layout(method=self._method, lengths=tuple(header.lengths))
        held = dict(zip(header.ids, header.revisions, strict=True))
        held.pop(GONE, None)
        vectors = Vectors.restored(layout, header.ids, arrays)
        if held == revisions:
            self._saved = state
            return vectors
        current = {shape_id for shape_id in held if revisions.get(shape_id) == held[shape_id]}
        vectors.remove(held.keys() - current)
        return put_all(self._gather(state, but=current), vectors)

    def _fits(self, header: Header, state: CatalogueState) -> bool:
        made_for = (header.library, header.epoch, header.vocabulary_id, header.blocks)
        return made_for == (state.library, state.epoch, state.vocabulary_id, self._names)

    def _gather(
        self, state: CatalogueState, after_revision: int = 0, but: Collection[str] = ()
    ) -> Iterator[Gathered]:
        rows = self._catalogue.block_rows(state.vocabulary_id, after_revision, self._names, but)
        return gather(rows, self._method)

    def _holds(self, state: CatalogueState) -> bool:
        # With another vocabulary active, the rows that were read may lack the old one's blocks.
        return _same_line(self._catalogue.state(), state)

    def _save_if_possible(self) -> None:
        try:
            self._save()
        except (OSError, StorageFull) as error:  # only a cache: the answer does not need it
            _log.warning("the index of %s was not saved: %s", self._method.name, error)

    def _save(self) -> None:
        state, vectors = self._state, self._vectors
        if state is None or vectors is None or state == self._saved:
            return
        revisions = self._catalogue.ready_revisions()
        ids = list(vectors.ids)
        shown = [revisions.get(shape_id, 0) for shape_id in ids]
        header = Header(
            library=state.library,
            epoch=state.epoch,
            vocabulary_id=state.vocabulary_id,
            blocks=self._names,
            lengths=list(vectors.layout.lengths),
            ids=ids,
            revisions=[revision if revision <= state.revision else 0 for revision in shown],
        )
        save_index(self._store, self._key, header, vectors.arrays())
        self._saved = state


def _same_line(one: CatalogueState, other: CatalogueState) -> bool:
    return (one.library, one.epoch) == (other.library, other.epoch)
