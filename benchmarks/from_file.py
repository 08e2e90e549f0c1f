"""What the whole path from a file to a stored row costs: against its eigen part, by stage, by size, by cores.

Run by `make bench`, or alone: python -m benchmarks.from_file [file or folder of meshes …]. Alone it also
indexes what is named, with one worker and with two.
"""

import argparse
import contextlib
import io
import statistics
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from PIL import Image
from threadpoolctl import threadpool_limits

from benchmarks.eigenpairs import describe_eigen_part
from service.commands.batch import index_sources
from service.commands.discovery import find_sources
from service.commands.indexing import AHEAD
from service.commands.opening import opened, settings_for, working
from service.intake.submissions import receive_paths
from service.jobs.describing import KeptFiles, describe_files, describe_in_words
from service.jobs.recording import record_description
from service.library import Library
from service.retrieval import accept_upload
from service.samples.atlas import unwrap
from service.samples.creatures import KINDS, make_creature
from service.samples.palettes import COATS
from service.samples.texturing import _obj, bake
from service.samples.writing import ply_bytes
from service.vocabularies import active_vocabulary
from worker.canonical import canonical_surface
from worker.describe import describe
from worker.descriptors.meshhog import mesh_features
from worker.geometry.repair import repair
from worker.parameters import Parameters
from worker.pictures.preview import preview
from worker.pictures.thumbnail import thumbnail
from worker.reading.upload import Upload, read_mesh

SIZE = 50_000  # vertices in
SIZES = (10_000, 20_000, 50_000, 100_000, 200_000)
PICTURE = 2_048  # texels along the texture
REPEATS = 3
WORKERS = (1, 2)

Row = Mapping[str, str]  # column → cell


def main() -> None:
    """Print all tables."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("paths", nargs="*", type=Path)
    paths = arguments.parse_args().paths
    with threadpool_limits(1):
        for row in (*whole_rows(), *stage_rows(), *size_rows()):
            print(row)
    for row in index_rows(paths) if paths else ():
        print(row)


def whole_rows(repeats: int = REPEATS) -> Iterator[Row]:
    """Yield the job of a textured OBJ from file to stored row, against its eigen part: CPU-seconds."""
    files, parameters = textured_obj(SIZE), Parameters()
    with stored(files) as (library, path):
        store_once(library, path, 0)  # compiles
        numbers = iter(range(1, repeats + 1))
        whole = median_of(lambda: store_once(library, path, next(numbers)), repeats)
    mesh = read_mesh(Upload(files=files))
    surface = canonical_surface(mesh, repair(mesh), parameters)
    eigen = median_of(lambda: describe_eigen_part(surface, parameters), repeats)
    yield {
        "what": f"file to stored row, textured OBJ, {len(mesh.vertices):,} vertices, {PICTURE} px",
        "whole, s": f"{whole:.3f}",
        "eigen part, s": f"{eigen:.3f}",
        "ratio": f"{whole / eigen:.2f}",
    }


def stage_rows(repeats: int = REPEATS) -> Iterator[Row]:
    """Yield what the stages of describing it cost beside the eigen part: CPU-milliseconds."""
    upload, parameters = Upload(files=textured_obj(SIZE)), Parameters()
    mesh = read_mesh(upload)
    repaired = repair(mesh)
    surface = canonical_surface(mesh, repaired, parameters)
    stages: Mapping[str, Callable[[], Any]] = {
        "read": lambda: read_mesh(upload),
        "repair": lambda: repair(mesh),
        "resample and colour": lambda: canonical_surface(mesh, repaired, parameters),
        "MeshHOG": lambda: mesh_features(surface.lab[:, 0], surface.vertices, surface.faces),
        "thumbnail": lambda: thumbnail(mesh, repaired),
        "preview": lambda: preview(surface.vertices, surface.faces, surface.srgb),
    }
    for name, stage in stages.items():
        seconds = median_of(stage, repeats)
        yield {"stage": name, "ms": f"{1e3 * seconds:.0f}"}


def size_rows(sizes: Sequence[int] = SIZES, repeats: int = REPEATS) -> Iterator[Row]:
    """Yield what describing costs by the number of vertices in: CPU-seconds."""
    for what, make in (("textured OBJ", textured_obj), ("coloured PLY", coloured_ply)):
        first = 0.0
        for size in sizes:
            upload = Upload(files=make(size))
            seconds = median_of(partial(describe, upload), repeats)
            first = first or seconds
            growth = {"times the smallest": f"{seconds / first:.2f}", "size": f"{size / sizes[0]:.0f}"}
            yield {"what": what, "vertices": f"{size:,}", "seconds": f"{seconds:.3f}", **growth}


def index_rows(paths: Sequence[Path], repeats: int = REPEATS) -> Iterator[Row]:
    """Yield shapes a second of `faience index` by workers: medians of wall time, workers in turn."""
    seconds: dict[int, list[float]] = {workers: [] for workers in WORKERS}
    n_shapes = sum(len(source.meshes) for source in find_sources(paths))
    for _ in range(repeats):
        for workers in WORKERS:
            seconds[workers].append(index_once(paths, workers))
    medians = {workers: statistics.median(found) for workers, found in seconds.items()}
    for workers, median in medians.items():
        yield {
            "workers": str(workers),
            "shapes a second": f"{n_shapes / median:.2f}",
            "against one": f"{medians[WORKERS[0]] / median:.2f}",
        }


def index_once(paths: Sequence[Path], workers: int) -> float:
    """Index into a new library; return the seconds from the first file on, children being warm."""
    with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
        library = stack.enter_context(opened(settings_for(Path(folder), workers=workers), make=True))
        helper = stack.enter_context(working(library))
        start = time.perf_counter()
        for _ in index_sources(library, find_sources(paths), False, helper, AHEAD * workers):
            pass
        return time.perf_counter() - start


def store_once(library: Library, paths: Mapping[str, Path], number: int) -> None:
    """Accept, describe and store an upload as the service does, in one process; each number is a new one."""
    marked = paths["m.mtl"]
    marked.write_text(f"{marked.read_text()}# {number}\n")
    accept_upload(library, receive_paths(paths))
    job = library.queue.claim("benchmark", 60.0)
    if job is None:
        raise LookupError("the queue is empty")
    shape = library.catalogue.get(job.shape_id)
    sent = KeptFiles(library.files, {file.name: file.key for file in shape.files})
    vocabulary = active_vocabulary(library)
    found = describe_in_words(describe_files, vocabulary, sent, False, library.parameters, library.limits)
    record_description(library, job, *found)


@contextlib.contextmanager
def stored(files: Mapping[str, bytes]) -> Iterator[tuple[Library, Mapping[str, Path]]]:
    """Write files to a folder beside a new library; yield both."""
    with tempfile.TemporaryDirectory() as folder:
        paths = {name: Path(folder) / name for name in files}
        for name, content in files.items():
            paths[name].write_bytes(content)
        with opened(settings_for(Path(folder) / "library"), make=True) as library:
            yield library, paths


def textured_obj(n_vertices: int) -> Mapping[str, bytes]:
    """Return the OBJ, MTL and PNG of one creature."""
    shell = _creature(n_vertices)
    atlas, picture = unwrap(shell, PICTURE), io.BytesIO()
    Image.fromarray(bake(shell, atlas)).save(picture, "PNG")
    material = b"newmtl skin\nKd 1 1 1\nmap_Kd m.png\n"
    return {"m.obj": _obj(shell, atlas, "m"), "m.mtl": material, "m.png": picture.getvalue()}


def coloured_ply(n_vertices: int) -> Mapping[str, bytes]:
    """Return the same creature as a binary PLY with coloured vertices."""
    return {"m.ply": ply_bytes(_creature(n_vertices))}


def _creature(n_vertices: int) -> Any:
    kind = KINDS["walker"]
    return make_creature(
        "walker", COATS["tiger"], next(iter(kind.poses.values())), n_vertices=n_vertices, offset=0.27
    )


def median_of(work: Callable[[], Any], repeats: int) -> float:
    """Return the median processor time of some work, in seconds."""
    found = []
    for _ in range(repeats):
        start = time.process_time()
        work()
        found.append(time.process_time() - start)
    return statistics.median(found)


if __name__ == "__main__":
    main()
