"""What tests of the evaluation share: a tiny folder, coarse parameters for it, its own vocabulary."""

import functools
from collections.abc import Callable
from concurrent.futures import Executor, Future
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from index.vocabulary import Vocabulary, learn_vocabulary
from service.evaluation.describing import Setting
from service.samples.creatures import KINDS, make_creature
from service.samples.palettes import COATS
from service.samples.writing import ply_bytes
from tests.shapes import box, coloured
from worker.canonical import canonical_surface
from worker.describe import describe_surface, in_single_precision
from worker.geometry.repair import repair
from worker.parameters import Parameters
from worker.reading.mesh import Colour, Mesh
from worker.reading.upload import Upload, read_mesh

COARSE = Parameters(vertices=300, colour_samples=2_000, distance_samples=100, landmarks=32)
CREATURES = {"fish": "reef", "bird": "parrot", "lizard": "jungle"}  # kind → coat; the last one is clutter

Value = TypeVar("Value")


class InThisProcess(Executor):
    """Runs what is submitted at once, and remembers the arguments."""

    def __init__(self) -> None:
        self.submitted: list[tuple[Any, ...]] = []

    def submit(self, fn: Callable[..., Value], /, *args: Any, **kwargs: Any) -> Future[Value]:
        """Run, and return what is done already."""
        self.submitted.append(args)
        done: Future[Value] = Future()
        done.set_result(fn(*args, **kwargs))
        return done


def textured_box(seed: int = 0) -> Mesh:
    """Return a box with an image of 6 × 6 texels on each side; its 36 corners wear the colours of those."""
    vertices, faces, uvs = box()
    texels = np.random.default_rng(seed).integers(0, 256, (6, 6, 3)).astype(np.uint8)
    mesh = coloured(vertices, faces, np.zeros_like(vertices))
    return replace(
        mesh,
        corner_uvs=uvs,
        face_textures=np.zeros(len(faces), dtype=np.int64),
        corner_colours=texels.reshape(12, 3, 3) / 255.0,
        textures=(texels,),
        colour=Colour.TEXTURE,
    )


@functools.cache
def creature_files() -> dict[str, bytes]:
    """Make two models in two poses each, and something else: path below a folder → PLY."""
    files = {}
    for kind, coat in CREATURES.items():
        for number, pose in enumerate(list(KINDS[kind].poses.values())[:2]):
            shell = make_creature(kind, COATS[coat], pose, n_vertices=400, offset=0.3 * number)
            files[f"posed/{kind}/pose_{number:02d}.ply"] = ply_bytes(shell)
    return {name: content for name, content in files.items() if "lizard" not in name} | {
        "clutter/lizard.ply": files["posed/lizard/pose_00.ply"]
    }


def make_folder(path: Path) -> Path:
    """Write the creatures below a path, and return it."""
    for name, content in creature_files().items():
        file = path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content)
    return path


@functools.cache
def coarse_vocabulary() -> Vocabulary:
    """Learn a vocabulary from the creatures."""
    signatures = []
    for content in creature_files().values():
        mesh = read_mesh(Upload(files={"mesh.ply": content}))
        surface = canonical_surface(mesh, repair(mesh), COARSE)
        signatures.append(in_single_precision(describe_surface(surface, COARSE)[1]))
    return learn_vocabulary(signatures, COARSE.fingerprint())


def setting_for(folder: Path, cache: Path) -> Setting:
    """Return the setting of a coarse evaluation."""
    return Setting(folder=folder, cache=cache, parameters=COARSE, vocabulary=coarse_vocabulary())
