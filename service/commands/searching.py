"""What `faience search` does: describe each file, rank the library, and forget the file."""

import json
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from rich.console import Console
from rich.table import Column, Table

from index.shapes import Status
from service.asking import Question, check_question
from service.commands.companions import Companions
from service.commands.discovery import Source, find_sources
from service.commands.explaining import explain
from service.commands.failures import CommandFailed, say
from service.commands.opening import opened, pool_for, settings_for
from service.intake.submissions import Submission, receive_paths
from service.jobs.pool import ProcessPerJob
from service.library import Library
from service.retrieval import Answer, search_upload


def search_files(
    files: Sequence[Path], data_dir: Path, question: Question, allow_untextured: bool, as_json: bool
) -> None:
    """Print a ranked answer for each file, in their order.

    Raises
    ------
    CommandFailed
        The library is empty, a file does not exist, or one of them could not be read.
    """
    check_question(question)
    for path in files:
        if path.is_dir():
            raise CommandFailed(f"{path} is a folder; name a mesh (.ply, .obj or .zip)")
    sources, settings = find_sources(files), settings_for(data_dir)
    with opened(settings) as library, pool_for(settings) as pool:
        if library.catalogue.counts()[Status.READY] == 0:
            raise CommandFailed(f"the library at {data_dir} is empty; `faience index PATH` fills it")
        submissions = _submissions(library, sources, allow_untextured)
        failed = sum(
            not _report(path, answer, as_json)
            for path, answer in _answers(library, pool, submissions, question)
        )
    if failed:
        raise CommandFailed(f"{failed} of {len(files)} queries could not be answered")


def _submissions(
    library: Library, sources: Iterable[Source], allow_untextured: bool
) -> list[tuple[Path, Submission | Exception]]:
    submissions: list[tuple[Path, Submission | Exception]] = []
    for source in sources:
        mesh, companions = source.meshes[0], Companions(source, library.limits)
        try:
            paths = companions.files_of(mesh)
            submissions.append((mesh.path, receive_paths(paths, allow_untextured=allow_untextured)))
        except Exception as error:  # noqa: BLE001 - reported with its file, or raised there
            submissions.append((mesh.path, error))
    return submissions


def _answers(
    library: Library,
    pool: ProcessPerJob,
    submissions: Iterable[tuple[Path, Submission | Exception]],
    question: Question,
) -> Iterator[tuple[Path, Answer | Exception]]:
    """Search in parallel, answer in order."""

    def search(submission: Submission | Exception) -> Answer | Exception:
        if isinstance(submission, Exception):
            return submission
        try:
            return search_upload(library, pool, submission, question)
        except Exception as error:  # noqa: BLE001 - reported with its file, or raised there
            return error

    listed = list(submissions)
    with ThreadPoolExecutor(max(library.settings.workers, 1)) as threads:
        answers = threads.map(search, [submission for _, submission in listed])
        yield from zip([path for path, _ in listed], answers, strict=True)


def _report(path: Path, answer: Answer | Exception, as_json: bool) -> bool:
    """Print an answer; return False where there is none."""
    if isinstance(answer, Exception):
        message = explain(answer)
        if message is None:
            raise answer
        say(f"{path}: {message}")
        return False
    if answer.partly is not None:
        done, total = answer.partly.done, answer.partly.total
        say(f"{path}: compared with {done} of {total} shapes; the others are still to be described anew")
    if as_json:
        print(_line(path, answer), flush=True)  # noqa: T201 - this is the command's output
    else:
        Console().print(answer_table(f"Nearest to {path} by {answer.method}", answer))
    return True


def _line(path: Path, answer: Answer) -> str:
    results = [
        {"rank": hit.rank, "name": hit.shape.name, "id": hit.shape.id, "distance": hit.distance}
        for hit in answer.hits
    ]
    return json.dumps({"query": str(path), "method": answer.method, "results": results})


def answer_table(title: str, answer: Answer) -> Table:
    """Return a ranked answer as a table."""
    identity = Column("id", no_wrap=True, min_width=32)
    named = Column("name", overflow="fold")  # the end of a path tells more than its beginning
    table = Table("rank", "distance", named, identity, title=title.replace("[", r"\["), title_justify="left")
    for hit in answer.hits:
        name = hit.shape.name.replace("[", r"\[")
        table.add_row(str(hit.rank), f"{hit.distance:.4f}", name, hit.shape.id)
    return table
