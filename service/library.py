"""What a data folder holds, opened: the one value that use cases are given."""

import shutil
from dataclasses import dataclass, field
from pathlib import Path

from sqlalchemy import Engine

from index.catalogue import Catalogue
from index.database import make_engine
from index.errors import NewerDescriptions, StorageFull
from index.file_places import open_files
from index.files import FileStore
from index.migrating import migrate
from index.queue import Queue
from index.searcher import Searcher
from index.upcoming import Upcoming
from index.vocabulary import Vocabulary, default_vocabulary
from service.intake.incoming import Incoming
from service.relations.postures import Postures
from service.reserve import Reserve
from service.settings import IndexKind, Settings
from worker.parameters import Parameters
from worker.reading.limits import Limits

NEWER = "a newer version of Faience described this library's shapes anew; update this one"
MIB = 2**20
RESERVED = 4  # the part of the space left by uploads that is held by a file, out of reach of other programs


@dataclass(frozen=True, kw_only=True, eq=False)
class Library:
    """The parts of one library, made in one place and handed down."""

    settings: Settings
    engine: Engine  # of the catalogue's database
    catalogue: Catalogue
    queue: Queue
    files: FileStore  # what was uploaded and what was made of it
    incoming: Incoming  # temporary files of uploads
    reserve: Reserve  # room to remove things on a full disk
    searcher: Searcher
    upcoming: Searcher  # among the shapes that are described anew already, while that goes on
    parameters: Parameters  # of every description that is made here
    limits: Limits  # on what is read
    postures: Postures = field(default_factory=Postures)  # read before
    vocabularies: dict[str, Vocabulary] = field(default_factory=dict)  # read before; one id, one content
    given: Vocabulary | None = None  # for these parameters, in place of the one that ships with the project

    @classmethod
    def open(
        cls,
        settings: Settings,
        *,
        parameters: Parameters | None = None,
        limits: Limits | None = None,
        vocabulary: Vocabulary | None = None,
    ) -> "Library":
        """Open or make the library of ``settings.data_dir``, migrated, with a vocabulary.

        Parameters
        ----------
        vocabulary : Vocabulary, optional
            For a library that has none yet, or none of these parameters; the one that ships with the project
            otherwise.

        Raises
        ------
        UnknownStorage, StorageUnreachable, UnknownDatabase
        NewerDescriptions
            A newer version of Faience described its shapes anew.
        """
        folder = settings.data_dir
        folder.mkdir(parents=True, exist_ok=True)
        files = open_files(settings.storage_url, folder / "files")
        engine = make_engine(settings.url, settings.busy_seconds)
        migrate(engine)
        catalogue = Catalogue(engine)
        searcher = _searcher(settings, catalogue, engine)
        parameters = parameters or Parameters()
        _provide_vocabulary(catalogue, parameters, vocabulary)
        return cls(
            settings=settings,
            engine=engine,
            catalogue=catalogue,
            queue=Queue(engine),
            files=files,
            incoming=Incoming(folder / "incoming"),
            reserve=Reserve(folder / "reserve", settings.reserve_bytes // RESERVED),
            searcher=searcher,
            upcoming=Searcher(Upcoming(engine), folder / "index-upcoming"),
            parameters=parameters,
            limits=limits or Limits(),
            given=vocabulary,
        )

    def check_space(self, size: int) -> None:
        """Leave room on the disk for what makes room, and see that the reserve is there.

        Parameters
        ----------
        size : int
            Bytes that are about to be written: on arrival, and for good where files are kept here.

        Raises
        ------
        StorageFull
        """
        for folder, needed in self._written(size).items():
            free = shutil.disk_usage(folder).free
            if free < self.settings.reserve_bytes + needed:
                raise StorageFull(
                    f"{free / MIB:.1f} MiB of the disk are free; {needed / MIB:.1f} are needed for this, "
                    f"beside {self.settings.reserve_bytes / MIB:.1f} that are left for removals"
                )
        self.reserve.fill()

    def _written(self, size: int) -> dict[Path, int]:
        """Return how many bytes an upload of a size writes, by a folder of each disk of this machine."""
        arrival, kept = self.settings.data_dir, self.files.folder
        if kept is None:
            return {arrival: size}
        apart = kept.exists() and kept.stat().st_dev != arrival.stat().st_dev  # made on first use
        return {arrival: size, kept: size} if apart else {arrival: 2 * size}

    def close(self) -> None:
        """Save what is only a cache and let go of the rest."""
        self.searcher.close()
        self.upcoming.close()
        self.incoming.close()
        self.engine.dispose()


def _searcher(settings: Settings, catalogue: Catalogue, engine: Engine) -> Searcher:
    """Return what ranks, with its vectors where the settings want them."""
    folder = settings.data_dir / "index"
    if settings.index == IndexKind.MEMORY:
        return Searcher(catalogue, folder)
    from index.pgvector.opening import views  # for whoever asks for it

    return Searcher(
        catalogue, folder, views(catalogue, engine, graph=settings.index == IndexKind.PGVECTOR_HNSW)
    )


def _provide_vocabulary(catalogue: Catalogue, parameters: Parameters, first: Vocabulary | None) -> None:
    """Activate a first vocabulary where there is none yet, if it fits the parameters."""
    if catalogue.left_behind(parameters.fingerprint()):
        raise NewerDescriptions(NEWER)
    if catalogue.state().vocabulary_id is not None:
        return
    first = first or default_vocabulary()
    if first.fingerprint == parameters.fingerprint():
        catalogue.add_vocabulary(first)
        catalogue.activate(first.id)
