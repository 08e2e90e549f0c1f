"""Searcher: ranked answers that are never older than the catalogue."""

from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from threading import Lock
from typing import Protocol

import numpy.typing as npt

from index.catalogue import Catalogue
from index.local_files import LocalFiles
from index.method_index import MethodIndex
from index.methods import Method, method, with_weights
from index.ranking import Ranked
from index.watch import stage

CATCH_UP, RANK = "catch_up", "rank"  # stages of a search

_LEFT_BEHIND = 3600.0  # seconds after which a half-written index file is nobody's


class View(Protocol):
    """The vectors of one method, wherever they are: see `MethodIndex` and `index.pgvector.index`."""

    escalations: int  # queries that took a second look to be proven, since the start

    @property
    def revision(self) -> int | None:
        """Return the catalogue's revision that is shown; None where nothing is yet."""

    def catch_up(self) -> None:
        """Bring the view to what the catalogue is now."""

    def proves(self, method: Method, limit: int) -> bool:
        """Whether answers to such a question are proven to be complete."""

    def rank(
        self,
        method: Method,
        blocks: Mapping[str, npt.ArrayLike],
        limit: int,
        exclude: Collection[str],
        vocabulary_id: str | None,
    ) -> Ranked:
        """Return the nearest shapes."""

    def save(self) -> None:
        """Keep the view for the next run."""


class Searcher:
    """Ranks the catalogue's ready shapes; each method's index is loaded when it is first asked for.

    Safe to share between threads; other processes may have their own on the same folder.

    Parameters
    ----------
    catalogue : Catalogue
        What is searched.
    folder : Path
        Where indexes are kept between runs. Only a cache: it may be emptied at any time.
    make : callable, optional
        Makes a method's view; otherwise it is a `MethodIndex`, in memory.
    """

    def __init__(
        self, catalogue: Catalogue, folder: Path, make: Callable[[Method], View] | None = None
    ) -> None:
        self._catalogue = catalogue
        self._store = LocalFiles(folder)
        self._store.sweep(_LEFT_BEHIND)
        self._make = make or self._in_memory
        self._indexes: dict[str, View] = {}
        self._opening = Lock()

    def search(
        self,
        method_name: str,
        query_blocks: Mapping[str, npt.ArrayLike],
        limit: int,
        *,
        weights: Mapping[str, float] | None = None,
        exclude: Collection[str] = (),
        vocabulary_id: str | None = None,
    ) -> Ranked:
        """Return the nearest shapes as (id, distance), nearest first, equal distances by id.

        Exactly what comparing the query with every ready shape in double precision would give, unless
        `proves` says otherwise. A shape that lacks one of the method's blocks is left out.

        Parameters
        ----------
        method_name : str
            See `index.methods.METHODS`.
        query_blocks : mapping of str to (n,) arrays
            The method's blocks, and perhaps others.
        limit : int
            How many at most.
        weights : mapping of str to float, optional
            Own weights for some of the method's blocks. They cost an exact comparison with every shape.
        exclude : collection of str
            Ids that are not wanted.
        vocabulary_id : str, optional
            Whose words the query is in; checked against the index.

        Raises
        ------
        UnknownMethod, BadWeights, BadBlock
            The question is wrong.
        VocabularyChanged
            Another vocabulary became active meanwhile: quantise the query again and repeat.
        """
        base = method(method_name)
        asked = with_weights(base, weights or {})
        found = self._index_of(base)
        with stage(CATCH_UP, method_name):
            found.catch_up()
        with stage(RANK, method_name):
            return found.rank(asked, query_blocks, limit, exclude, vocabulary_id)

    def load(self, method_name: str) -> None:
        """Have a method's index ready before it is asked for.

        Raises
        ------
        UnknownMethod
        """
        self._index_of(method(method_name)).catch_up()

    def revisions(self) -> dict[str, int]:
        """Return the catalogue's revision that each loaded index shows, by method."""
        with self._opening:
            loaded = dict(self._indexes)
        shown = {name: each.revision for name, each in loaded.items()}
        return {name: revision for name, revision in shown.items() if revision is not None}

    def proves(self, method_name: str, limit: int, weights: Mapping[str, float] | None = None) -> bool:
        """Whether no shape can be missing from the answer to such a question.

        Raises
        ------
        UnknownMethod, BadWeights
        """
        base = method(method_name)
        return self._index_of(base).proves(with_weights(base, weights or {}), limit)

    def escalations(self) -> dict[str, int]:
        """Return, by method, how many queries took a second look to be proven, since the start."""
        with self._opening:
            return {name: index.escalations for name, index in self._indexes.items()}

    def save(self) -> None:
        """Keep every index that is loaded for the next run."""
        with self._opening:
            loaded = list(self._indexes.values())
        for each in loaded:
            each.save()

    def forget(self) -> None:
        """Let go of every index that is loaded."""
        with self._opening:
            self._indexes.clear()

    @property
    def loaded(self) -> bool:
        """Whether any index is in memory."""
        return bool(self._indexes)

    def close(self) -> None:
        """Save, as the last thing."""
        self.save()

    def _index_of(self, base: Method) -> View:
        with self._opening:
            if base.name not in self._indexes:
                self._indexes[base.name] = self._make(base)
            return self._indexes[base.name]

    def _in_memory(self, base: Method) -> View:
        return MethodIndex(base, self._catalogue, self._store)
