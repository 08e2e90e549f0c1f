"""The page's own files, held in memory: nothing else can be asked for by their names."""

import gzip
import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable

TYPES = {".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml"}


@dataclass(frozen=True, kw_only=True)
class PageFile:
    """One file of the page."""

    media_type: str
    content: bytes
    packed: bytes  # the content by gzip
    tag: str  # changes with the content: a browser asks whether its copy is still right


@cache
def page_files() -> Mapping[str, PageFile]:
    """Return the page's files by their paths below ``service/static``."""
    return dict(_below(files("service") / "static", ""))


def _below(folder: Traversable, prefix: str) -> Iterator[tuple[str, PageFile]]:
    for entry in folder.iterdir():
        if entry.is_dir():
            yield from _below(entry, f"{prefix}{entry.name}/")
        elif (suffix := entry.name[entry.name.rfind(".") :]) in TYPES:
            yield prefix + entry.name, _page_file(entry.read_bytes(), TYPES[suffix])


def _page_file(content: bytes, media_type: str) -> PageFile:
    digest = hashlib.sha256(content).hexdigest()[:32]
    packed = gzip.compress(content, mtime=0)
    return PageFile(media_type=media_type, content=content, packed=packed, tag=f'"{digest}"')
