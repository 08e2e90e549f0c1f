"""A multipart form, written to files while it arrives."""

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, TypeVar

from python_multipart import MultipartParser
from python_multipart.exceptions import FormParserError
from python_multipart.multipart import parse_options_header

from service.intake.submissions import ReceivedFile, safe_name

Value = TypeVar("Value")


class UploadRefused(Exception):
    """An upload is refused for its form, before its mesh is looked at."""

    code = "bad_upload"


class NotMultipart(UploadRefused):
    """The body is not multipart/form-data."""

    code = "not_multipart"


class BadMultipart(UploadRefused):
    """The body breaks the rules of multipart/form-data."""

    code = "bad_multipart"


class IncompleteBody(UploadRefused):
    """The body ended before its closing boundary."""

    code = "incomplete_body"


class TooManyFiles(UploadRefused):
    """More files or fields than one upload may have."""

    code = "too_many_files"


class FieldTooLong(UploadRefused):
    """A text field is longer than allowed."""

    code = "field_too_long"


@dataclass(frozen=True, kw_only=True)
class FormLimits:
    """Bounds on a form."""

    files: int  # how many
    field_bytes: int  # of one text field
    fields: int = 16  # how many


class FormReceiver:
    """Takes a body piece by piece; files go to ``folder``, text fields to memory.

    Parameters
    ----------
    content_type : str
        The request's header, which holds the boundary.
    folder : Path
        An empty folder for the files, named by number: names from outside never become paths.

    Raises
    ------
    UploadRefused
        From every method, when the form is not well made or too big.
    """

    def __init__(self, content_type: str, folder: Path, limits: FormLimits) -> None:
        kind, options = parse_options_header(content_type)
        if kind != b"multipart/form-data" or not options.get(b"boundary"):
            raise NotMultipart(f"expected multipart/form-data with a boundary, got {content_type[:100]!r}")
        self.files: list[ReceivedFile] = []
        self.fields: dict[str, str] = {}
        self._folder, self._limits = folder, limits
        self._complete = False
        self._header_name, self._header_value = b"", b""
        self._disposition = b""
        self._part: _FilePart | _FieldPart | None = None
        self._parser = _checked(lambda: self._make_parser(options[b"boundary"]))

    def write(self, chunk: bytes) -> None:
        """Take the next piece of the body."""
        _checked(lambda: self._parser.write(chunk))

    def finish(self) -> None:
        """Check that the closing boundary came."""
        if not self._complete:
            raise IncompleteBody("the body ended before its closing boundary; nothing was kept")

    def close(self) -> None:
        """Close a file that is still open; for a form that is given up."""
        if isinstance(self._part, _FilePart):
            self._part.stream.close()

    def _make_parser(self, boundary: bytes) -> MultipartParser:
        return MultipartParser(
            boundary,
            {
                "on_part_begin": self._begin,
                "on_header_field": self._add_header_name,
                "on_header_value": self._add_header_value,
                "on_header_end": self._end_header,
                "on_headers_finished": self._open_part,
                "on_part_data": self._add_data,
                "on_part_end": self._end_part,
                "on_end": self._end,
            },
        )

    def _begin(self) -> None:
        self._disposition = b""

    def _add_header_name(self, data: bytes, start: int, end: int) -> None:
        self._header_name += data[start:end]

    def _add_header_value(self, data: bytes, start: int, end: int) -> None:
        self._header_value += data[start:end]

    def _end_header(self) -> None:
        if self._header_name.lower() == b"content-disposition":
            self._disposition = self._header_value
        self._header_name, self._header_value = b"", b""

    def _open_part(self) -> None:
        _, options = parse_options_header(self._disposition)
        if b"name" not in options:
            raise BadMultipart("a part has no name in its Content-Disposition header")
        name = _text(options[b"name"])
        if b"filename" in options:
            self._part = self._open_file(name, _text(options[b"filename"]))
        else:
            self._part = self._open_field(name)

    def _open_file(self, field: str, file_name: str) -> "_FilePart":
        if field != "files":
            raise BadMultipart(f"files are expected in the field 'files', got one in {field!r}")
        if len(self.files) == self._limits.files:
            raise TooManyFiles(f"more than {self._limits.files} files in one upload")
        name = safe_name(file_name)
        if name in {file.name for file in self.files}:
            raise BadMultipart(f"two files are named {name!r}")
        return _FilePart(name, self._folder / str(len(self.files)))

    def _open_field(self, name: str) -> "_FieldPart":
        if name == "files":
            raise BadMultipart("a part of the field 'files' has no file name (`filename=\"…\"`)")
        if len(self.fields) == self._limits.fields:
            raise TooManyFiles(f"more than {self._limits.fields} fields in one upload")
        if name in self.fields:
            raise BadMultipart(f"the field {name!r} was sent twice")
        return _FieldPart(name, self._limits.field_bytes)

    def _add_data(self, data: bytes, start: int, end: int) -> None:
        if self._part is not None:
            self._part.add(data[start:end])

    def _end_part(self) -> None:
        if isinstance(self._part, _FilePart):
            self.files.append(self._part.end())
        elif isinstance(self._part, _FieldPart):
            self.fields[self._part.name] = self._part.end()
        self._part = None

    def _end(self) -> None:
        self._complete = True


class _FilePart:
    """A file that is being received."""

    def __init__(self, name: str, path: Path) -> None:
        self.name, self.path, self.size = name, path, 0
        self.stream: BinaryIO = path.open("wb")
        self._hash = hashlib.sha256()

    def add(self, data: bytes) -> None:
        self.stream.write(data)
        self._hash.update(data)
        self.size += len(data)

    def end(self) -> ReceivedFile:
        self.stream.close()
        return ReceivedFile(name=self.name, path=self.path, size=self.size, sha256=self._hash.hexdigest())


class _FieldPart:
    """A text field that is being received."""

    def __init__(self, name: str, limit: int) -> None:
        self.name, self._limit, self._data = name, limit, bytearray()

    def add(self, data: bytes) -> None:
        if len(self._data) + len(data) > self._limit:
            raise FieldTooLong(f"the field {self.name!r} is longer than {self._limit} bytes")
        self._data += data

    def end(self) -> str:
        return _text(bytes(self._data))


def _text(data: bytes) -> str:
    try:
        return data.decode()
    except UnicodeDecodeError as error:
        raise BadMultipart("a name or a text field is not UTF-8") from error


def _checked(call: Callable[[], Value]) -> Value:
    try:
        return call()
    except FormParserError as error:
        raise BadMultipart(f"the body is not well-formed multipart/form-data: {error}") from error
