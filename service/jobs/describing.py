"""What a job computes, in the child: stored files in, `Description` out."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from index.files import FileStore
from index.vocabulary import Vocabulary
from service.quantisation import quantise
from worker.arrays import SingleArray
from worker.describe import Description, describe
from worker.parameters import Parameters
from worker.reading.limits import Limits
from worker.reading.upload import Upload

Describe = Callable[[Mapping[str, bytes], bool, Parameters, Limits], Description]


@dataclass(frozen=True, kw_only=True, eq=False)
class InWords:
    """The blocks of a description that depend on a vocabulary."""

    vocabulary_id: str
    blocks: Mapping[str, SingleArray]  # as from `quantise`


class FilesOnDisk(Mapping[str, bytes]):
    """The files of an upload that lie on this machine, each read when it is asked for.

    Parameters
    ----------
    paths : Mapping[str, Path]
        Name as uploaded → where the bytes are.
    """

    def __init__(self, paths: Mapping[str, Path]) -> None:
        self._paths = paths

    def __getitem__(self, name: str) -> bytes:
        return self._paths[name].read_bytes()

    def __iter__(self) -> Iterator[str]:
        return iter(self._paths)

    def __len__(self) -> int:
        return len(self._paths)


class KeptFiles(Mapping[str, bytes]):
    """The files of a stored shape, each read when it is asked for; small where it is pickled.

    Parameters
    ----------
    files : FileStore
        Which a process elsewhere can open, too.
    keys : Mapping[str, str]
        Name as uploaded → where the store has it.
    """

    def __init__(self, files: FileStore, keys: Mapping[str, str]) -> None:
        self._files, self._keys = files, keys

    @property
    def here(self) -> bool:
        """Whether they lie on this machine's disks, where others do not see them."""
        return self._files.folder is not None

    def __getitem__(self, name: str) -> bytes:
        return self._files.get(self._keys[name])

    def __iter__(self) -> Iterator[str]:
        return iter(self._keys)

    def __len__(self) -> int:
        return len(self._keys)


def describe_files(
    files: Mapping[str, bytes], allow_untextured: bool, parameters: Parameters, limits: Limits
) -> Description:
    """Describe an upload.

    Parameters
    ----------
    files : Mapping[str, bytes]
        Name as uploaded → bytes, which may be read when they are asked for.
    allow_untextured : bool
        Whether a named texture may be missing.

    Raises
    ------
    MeshError
        Why it is refused.
    """
    upload = Upload(files=files, allow_untextured=allow_untextured)
    return describe(upload, parameters, limits)


def describe_in_words(
    describe: Describe,
    vocabulary: Vocabulary | None,
    files: Mapping[str, bytes],
    allow_untextured: bool,
    parameters: Parameters,
    limits: Limits,
) -> tuple[Description, InWords | None]:
    """Describe an upload and quantise what came out, so that the parent only has to store it.

    Parameters
    ----------
    describe : callable
        As `describe_files`, which takes the other arguments.
    vocabulary : Vocabulary, optional
        The active one, if there is any.
    """
    description = describe(files, allow_untextured, parameters, limits)
    if vocabulary is None or vocabulary.fingerprint != description.fingerprint:
        return description, None
    blocks = quantise(description.signatures, vocabulary)
    return description, InWords(vocabulary_id=vocabulary.id, blocks=blocks)
