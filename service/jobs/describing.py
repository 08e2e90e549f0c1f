"""What a job computes, in the child: stored files in, `Description` out."""

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from worker.describe import Description, describe
from worker.parameters import Parameters
from worker.reading.limits import Limits
from worker.reading.upload import Upload

Describe = Callable[[Mapping[str, Path], bool, Parameters, Limits], Description]


class FilesOnDisk(Mapping[str, bytes]):
    """The files of an upload, each read when it is asked for.

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


def describe_files(
    paths: Mapping[str, Path], allow_untextured: bool, parameters: Parameters, limits: Limits
) -> Description:
    """Read an upload from its files and describe it.

    Parameters
    ----------
    paths : Mapping[str, Path]
        Name as uploaded → where the bytes are.
    allow_untextured : bool
        Whether a named texture may be missing.

    Raises
    ------
    MeshError
        Why it is refused.
    """
    upload = Upload(files=FilesOnDisk(paths), allow_untextured=allow_untextured)
    return describe(upload, parameters, limits)
