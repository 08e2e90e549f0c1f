"""Two versions of Faience that describe differently: where their numbers are mixed, it is noticed."""

import contextlib
import dataclasses
import functools
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Executor, Future
from typing import Any

import numpy as np

from index.jobs import Job
from index.vocabulary import Vocabulary, learn_vocabulary
from service.intake.submissions import receive_paths
from service.jobs.recording import record_description, record_failure
from service.jobs.renewing import Renewing
from service.jobs.workers import Worker
from service.library import Library
from service.retrieval import accept_upload
from service.settings import Settings
from tests.fakes import coloured_triangle, describe_quickly, fake_signatures
from worker.describe import Description
from worker.errors import Code, MeshError
from worker.parameters import Parameters
from worker.reading.limits import Limits

NEW = Parameters(vertices=4_999)
NEW_LENGTHS = {"colour-histogram": 4095, "colour-curves": 143}  # others than those of fakes
REFUSED = "refused.ply"  # by the new version, not by the old one
SLOW = 0.2  # seconds that a slow description takes at least


def describe_newly(
    files: Mapping[str, bytes], allow_untextured: bool, parameters: Parameters, limits: Limits
) -> Description:
    """Describe as the version of `parameters` does."""
    described = describe_quickly(files, allow_untextured, parameters, limits)
    if parameters != NEW:
        return described
    if REFUSED in files:
        raise MeshError(Code.TOO_COMPLEX, "the new version cannot")
    blocks = dict(described.blocks)
    for name, length in NEW_LENGTHS.items():
        blocks[name] = np.resize(blocks[name][::-1] ** 2, length).astype(np.float32)
    facts = dataclasses.replace(described.facts, area=2.0)
    return dataclasses.replace(described, blocks=blocks, facts=facts)


def describe_slowly(
    files: Mapping[str, bytes], allow_untextured: bool, parameters: Parameters, limits: Limits
) -> Description:
    """Describe newly, but so slowly that a process can be killed on the way."""
    time.sleep(SLOW)
    return describe_newly(files, allow_untextured, parameters, limits)


@functools.cache
def new_vocabulary() -> Vocabulary:
    samples = [fake_signatures(level) for level in np.linspace(0, 2, 7)]
    return learn_vocabulary(samples, NEW.fingerprint(), seed=1)


def open_new_library(settings: Settings) -> Library:
    """Open a library as the new version does."""
    return Library.open(settings, parameters=NEW, vocabulary=new_vocabulary())


def accept(library: Library, red: int, name: str = "mesh.ply") -> str:
    """Hand in a mesh of its own colour; return its id."""
    with library.incoming.scratch() as folder:
        path = folder / name
        path.write_bytes(coloured_triangle(red=red))
        return accept_upload(library, receive_paths({name: path}, name=f"shape {red}"))[0].id


def work_off(library: Library) -> None:
    """Describe whatever is queued, in this process."""
    while step(library):
        pass


def step(library: Library) -> bool:
    """Do what a worker does until one job is done; return whether there was one."""
    job = next_job(library)
    if job is None:
        return False
    do(library, job)
    return True


def next_job(library: Library) -> Job | None:
    """Take a job as a worker does."""
    renewing = Renewing(library)
    if not renewing.may_describe():
        return None
    fingerprint = library.parameters.fingerprint()
    job = library.queue.claim("steps", 60, fingerprint)
    if job is None and renewing.go_on():
        job = library.queue.claim("steps", 60, fingerprint)
    return job


def do(library: Library, job: Job) -> None:
    """Describe a job's shape, and record what came of it."""
    shape = library.catalogue.get(job.shape_id)
    files = {file.name: library.files.get(file.key) for file in shape.files}
    try:
        described = describe_newly(files, shape.allow_untextured, library.parameters, library.limits)
        record_description(library, job, described)
    except MeshError as error:
        record_failure(library, job, error.code, error.detail)


def work_newly(settings: Settings) -> None:
    """Be a worker of the new version until somebody kills this process."""
    library = open_new_library(settings)
    Worker(library, Here(), slots=1, describe=describe_slowly).run()


class Here(Executor):
    """Runs a job at once, without a process."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Run it."""
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:  # noqa: BLE001 - this is what executors do
            future.set_exception(error)
        return future


@contextlib.contextmanager
def working(library: Library) -> Iterator[None]:
    """Run a worker of the new version beside what is done here."""
    worker = Worker(library, Here(), slots=1, describe=describe_newly)
    thread = threading.Thread(target=worker.run)
    thread.start()
    try:
        yield
    finally:
        worker.stop()
        thread.join()
