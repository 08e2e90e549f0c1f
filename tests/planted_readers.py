"""Readers that break one promise each, so that tests see the fuzz notice it."""

import os
import signal
import time
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from worker.compiled import compiled
from worker.errors import Code, MeshError
from worker.reading.mesh import Mesh
from worker.reading.upload import Upload, read_mesh


def crash(upload: Upload) -> Mesh:
    os.kill(os.getpid(), signal.SIGSEGV)
    return read_mesh(upload)


def hang(upload: Upload) -> Mesh:
    time.sleep(3600)
    return read_mesh(upload)


def spin(_: Upload) -> Mesh:
    while True:
        pass


def eat_memory(upload: Upload) -> Mesh:
    kept = [np.ones(2**24) for _ in range(2**10)]  # 128 MiB each
    raise AssertionError(f"nobody stopped it: {len(kept)} {len(upload.files)}")


def read_beyond(upload: Upload) -> Mesh:
    """Read a number that is not in an array, in a compiled loop."""
    _beyond(np.zeros(3), 3)
    return read_mesh(upload)


@compiled
def _beyond(numbers: npt.NDArray[np.float64], place: int) -> float:
    return float(numbers[place])


def forget_a_number(upload: Upload) -> Mesh:
    mesh = read_mesh(upload)
    return replace(mesh, vertices=np.full_like(mesh.vertices, np.nan))


def name_a_vertex_too_many(upload: Upload) -> Mesh:
    mesh = read_mesh(upload)
    return replace(mesh, faces=mesh.faces + len(mesh.vertices))


def colour_too_brightly(upload: Upload) -> Mesh:
    mesh = read_mesh(upload)
    return replace(mesh, corner_colours=mesh.corner_colours + 1.5)


def raise_what_is_no_refusal(upload: Upload) -> Mesh:
    raise IndexError(f"{len(upload.files)} files")


def show_the_inside(upload: Upload) -> Mesh:
    raise MeshError(Code.BAD_DATA, f"found {b'x' * len(upload.files)!r}")


def say_nothing(upload: Upload) -> Mesh:
    raise MeshError(Code.BAD_DATA, " " * len(upload.files))


def disturb_the_screen(upload: Upload) -> Mesh:
    raise MeshError(Code.BAD_DATA, f"{len(upload.files)} files \x1b[31m")


def refuse_at_random(_: Upload) -> Mesh:
    raise MeshError(Code.BAD_DATA, f"nobody knows why: {os.urandom(8).hex()}")


def accept_anything(upload: Upload) -> Mesh:
    """Read a mesh that was not sent, whatever was."""
    sheet = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
    return read_mesh(Upload(files={"m.obj": sheet}, allow_untextured=upload.allow_untextured))
