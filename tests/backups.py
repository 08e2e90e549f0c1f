"""Libraries to be exported, and archives that nobody honest wrote."""

import hashlib
import io
import json
import tarfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from sqlalchemy import select

from index.database import reading
from index.jobs import Job
from index.schema import library_tables
from index.shapes import Shape
from service.backup.exporting import export_library
from service.intake.submissions import receive_paths
from service.jobs.recording import record_description
from service.library import Library
from service.retrieval import accept_upload, change_shape, remove_shape
from tests.fakes import coloured_triangle, fake_description
from tests.serving import open_fake_library, settings_for
from worker.reading.limits import Limits
from worker.reading.upload import Upload, read_mesh

Rows = dict[str, list[dict[str, Any]]]  # of each table
Parts = dict[str, bytes]  # an archive's members, in their order

# What came after the first schema.
LATER_TABLES = ("dismissals", "tags", "renewals")
LATER_COLUMNS = {
    "shapes": ("made_in",),
    "jobs": ("queued_at", "claimed_at", "fingerprint"),
    "state": ("next_vocabulary_id",),
    "plain_blocks": ("fingerprint",),
}


@contextmanager
def opened(folder: Path) -> Iterator[Library]:
    """Open a library, made where there is none."""
    library = open_fake_library(settings_for(folder))
    try:
        yield library
    finally:
        library.close()


def add_queued(library: Library, red: int, **metadata: object) -> Shape:
    """Hand in a mesh of its own colour."""
    with library.incoming.scratch() as folder:
        path = folder / "mesh.ply"
        path.write_bytes(coloured_triangle(red=red))
        submission = receive_paths({"mesh.ply": path}, name=f"shape é {red}", metadata=metadata)
        return accept_upload(library, submission)[0]


def add_ready(library: Library, red: int, **metadata: object) -> Shape:
    """Hand in a mesh and describe it; nothing else may wait in the queue."""
    shape = add_queued(library, red, **metadata)
    described = describe(library, red)
    if described.id != shape.id:
        raise RuntimeError(f"expected the job of {shape.id}, got that of {described.id}")
    return described


def claimed(library: Library) -> Job:
    """Take the oldest job, for an hour."""
    job = library.queue.claim("a worker", 3600)
    if job is None:
        raise RuntimeError("expected a job")
    return job


def describe(library: Library, red: int) -> Shape:
    """Do the oldest job, as if its mesh had that colour."""
    job = claimed(library)
    mesh = read_mesh(Upload(files={"mesh.ply": coloured_triangle(red=red)}), Limits())
    return record_description(library, job, fake_description(mesh, library.parameters))


def fail(library: Library) -> None:
    """Give up the oldest job."""
    library.catalogue.record_failed(claimed(library), code="zero_area", detail="it has no area")


def fill(library: Library) -> None:
    """Bring shapes in every state: ready, failed, processing, queued, and one that was removed."""
    for red in (10, 60, 110, 160):
        shape = add_ready(library, red, kind="made", year=2011 + red, nested={"a": [1, None, 0.5]})
    change_shape(library, shape.id, name="renamed \u2603")
    remove_shape(library, add_ready(library, 210).id)
    add_queued(library, 240)
    fail(library)
    add_queued(library, 245)
    claimed(library)
    add_queued(library, 250)


def exported(folder: Path, name: str = "library.tar") -> Path:
    """Make a filled library in a folder, and export it."""
    with opened(folder / "from") as library:
        fill(library)
        export_library(library, folder / name)
    return folder / name


def rows_of(library: Library) -> Rows:
    """Return every row of every table, in the order of the tables' names."""
    with reading(library.engine) as session:
        connection = session.connection()
        tables = {table.name: table for table in library_tables(connection)}
        return {
            name: sorted((dict(row) for row in connection.execute(select(table)).mappings()), key=repr)
            for name, table in sorted(tables.items())
        }


def released(rows: Rows) -> Rows:
    """Return the rows as an export has them: whoever held a job holds it no longer."""
    for job in rows["jobs"]:
        job.update(attempts=0, lease_until=None, claimed_at=None, worker=None, token=None)
    for shape in rows["shapes"]:
        if shape["status"] == "processing":
            shape["status"] = "queued"
    return {name: sorted(table, key=repr) for name, table in rows.items()}


def files_of(library: Library) -> dict[str, bytes]:
    """Return every file that is kept."""
    return {key: library.files.get(key) for key in library.files.keys()}  # noqa: SIM118 - no mapping


def parts_of(path: Path) -> Parts:
    """Return an archive's members."""
    parts: Parts = {}
    with tarfile.open(path) as archive:
        for member in archive:
            stream = archive.extractfile(member)
            parts[member.name] = b"" if stream is None else stream.read()
    return parts


def with_sums(parts: Parts) -> Parts:
    """Return the parts with checksums that are right."""
    kept = {name: data for name, data in parts.items() if name != "SHA256SUMS"}
    lines = [f"{hashlib.sha256(data).hexdigest()}  {name}\n" for name, data in kept.items()]
    return {**kept, "SHA256SUMS": "".join(lines).encode()}


def write_parts(path: Path, parts: Parts) -> Path:
    """Write members as they are."""
    with tarfile.open(path, "w", format=tarfile.USTAR_FORMAT) as archive:
        for name, data in parts.items():
            info = tarfile.TarInfo(name)
            info.size = len(data)
            archive.addfile(info, io.BytesIO(data))
    return path


def forged(path: Path, change: Callable[[Parts], Parts | None]) -> Path:
    """Write an archive again with something changed, and with checksums that are right."""
    parts = parts_of(path)
    return write_parts(path.with_name("forged.tar"), with_sums(change(parts) or parts))


def of_the_first_schema(parts: Parts) -> Parts:
    """Return the parts as the first version would have written them."""
    header = json.loads(parts["library.json"])
    kept = {name: data for name, data in parts.items() if name not in map(_rows_member, LATER_TABLES)}
    counts = {name: number for name, number in header["counts"].items() if name not in LATER_TABLES}
    kept["library.json"] = json.dumps({**header, "schema": "0001", "counts": counts}).encode()
    for table, columns in LATER_COLUMNS.items():
        rows = map(json.loads, kept[_rows_member(table)].splitlines())
        earlier = [{name: row[name] for name in row if name not in columns} for row in rows]
        kept[_rows_member(table)] = b"".join(json.dumps(row).encode() + b"\n" for row in earlier)
    return kept


def _rows_member(table: str) -> str:
    return f"tables/{table}.jsonl"


def edited(data: bytes, line: int, /, **changes: Any) -> bytes:
    """Return the rows of a table, one of them with other values."""
    rows = data.splitlines()
    rows[line] = json.dumps({**json.loads(rows[line]), **changes}).encode()
    return b"\n".join(rows) + b"\n"
