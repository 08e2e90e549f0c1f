"""The body of an upload: files by their paths, opened anew for each try."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import IO, Any

Source = str | Path | tuple[str, bytes]  # a path, or a name and what the file holds

Part = tuple[str, tuple[str, IO[bytes] | bytes]]


class Upload:
    """Files of one mesh, and the fields that go with them.

    Parameters
    ----------
    sources : tuple of str, Path or (str, bytes)
        A PLY, an OBJ with its MTL and images, or a zip.
    fields : mapping of str to str
    """

    def __init__(self, sources: tuple[Source, ...], fields: Mapping[str, str]) -> None:
        if not sources:
            raise ValueError("an upload needs at least one file")
        self._sources, self._fields = sources, dict(fields)

    @contextmanager
    def bodies(self) -> Iterator[Callable[[], dict[str, Any]]]:
        """Yield what makes the body of one try; files are closed at the end."""
        with ExitStack() as stack:

            def body() -> dict[str, Any]:
                stack.close()  # those of the try before
                return {"files": [_part(source, stack) for source in self._sources], "data": self._fields}

            yield body


def _part(source: Source, stack: ExitStack) -> Part:
    if isinstance(source, tuple):
        return "files", source
    path = Path(source)
    return "files", (path.name, stack.enter_context(path.open("rb")))
