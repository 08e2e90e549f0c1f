"""Meshes whose relations are known: each model exported anew, remeshed, recoloured, bent and cut."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from service.evaluation.damage import cut_away
from service.evaluation.folder import Model, read_folder
from service.evaluation.photometric import CHANGES, PHOTOMETRIC, recolour
from service.evaluation.protocol import random_of
from service.evaluation.sources import read_source
from service.evaluation.twins import make_twin
from service.samples.creatures import KINDS, make_creature, random_pose
from service.samples.palettes import random_coat
from service.samples.proportions import random_proportions
from service.samples.writing import ply_bytes
from worker.arrays import FloatArray, IntArray
from worker.geometry.areas import edge_lengths
from worker.geometry.refinement import split_long_edges
from worker.geometry.resampling import edge_of, face_areas
from worker.pictures.clustering import cluster
from worker.reading.mesh import Colour, Mesh
from worker.reading.upload import Upload, read_mesh

STRENGTHS = (1, 3, 5)  # of changes of light and colour
CUTS = (2, 3, 4, 5, 8)  # strengths: 6 % of the area each
FAINT = 1e-3  # of an edge: what a colour of 1 counts as, where edges are halved
FINEST = 30_000  # vertices, about, beyond which edges are not halved
CUBES = 128  # along the longest side, where a mesh is made coarser
TWINS = (0, 1)
MADE = 12  # models of a set that are made by code
POSES = 3  # of each of them
SEED = 1789  # of those

Read = Callable[[], Mesh]


@dataclass(frozen=True, kw_only=True)
class Variant:
    """A mesh, and what decides its relation to another."""

    part: str  # of the measurement: thresholds are chosen on one and validated on another
    model: str  # two with the same have the same surface
    pose: str = "0"
    coat: str = "own"  # its colours
    form: str = "plain"  # how it was written or meshed; changes no relation
    cut: int = 0  # strength of what is cut away
    still: bool = False  # a thing that has no poses

    @property
    def name(self) -> str:
        """Unique."""
        return "/".join((self.part, self.model, self.pose, self.coat, self.form, str(self.cut)))


def surfaces(folder: Path) -> dict[Variant, tuple[Read, list[Variant]]]:
    """Return every surface to be described, how it is read, and the colourings that share its triangles."""
    found: dict[Variant, tuple[Read, list[Variant]]] = {}
    for plain, read in _sources(folder):
        whole = plain.pose in ("0", "")
        for form in FORMS if whole else ("plain", "exported") if plain.pose == "1" else ("plain",):
            variant = replace(plain, form=form)
            found[variant] = partial(_formed, read, form, variant), [variant, *_colourings(variant)]
        for cut in CUTS if whole and not plain.still else ():
            variant = replace(plain, cut=cut)
            found[variant] = partial(_cut, read, variant), [variant]
    return found


def coloured(mesh: Mesh, variant: Variant) -> Mesh:
    """Give a mesh the colours of a variant."""
    if variant.coat == "own":
        return mesh
    change, strength = variant.coat.split(" ")
    if change == "twin":
        return make_twin(mesh, variant.model, int(strength))
    return recolour(mesh, change, int(strength), random_of(variant.name))


def _colourings(plain: Variant) -> Iterator[Variant]:
    if plain.pose == "1" and plain.form == "plain":
        yield replace(plain, coat="contrast- 3")
    if plain.pose != "0" or plain.form not in ("plain", "exported"):
        return
    if plain.form == "exported":  # turned: noise and twins follow from places, and would be others
        yield from (replace(plain, coat=f"{change} 3") for change in CHANGES)
        return
    strengths = (3,) if plain.still else STRENGTHS
    yield from (replace(plain, coat=f"{change} {s}") for change in PHOTOMETRIC for s in strengths)
    yield from (replace(plain, coat=f"twin {number}") for number in TWINS)


def _sources(folder: Path) -> Iterator[tuple[Variant, Read]]:
    listed = read_folder(folder)
    for model in listed.models:
        part = "choosing" if "/mh_" in model.rest else "validating"
        yield from _poses(folder, model, part)
    for place, path in enumerate(listed.clutter):
        part = ("choosing", "validating")[place % 2]
        variant = Variant(part=part, model=Path(path).stem, still=True)
        yield variant, partial(read_source, folder, path)
    for number in range(2 * MADE):
        part = ("choosing", "validating")[number // MADE]
        for pose in range(POSES):
            yield Variant(part=part, model=f"made {number}", pose=str(pose)), partial(_made, number, pose)


def _poses(folder: Path, model: Model, part: str) -> Iterator[tuple[Variant, Read]]:
    for pose, path in enumerate((model.rest, *model.others)):
        yield Variant(part=part, model=model.name, pose=str(pose)), partial(read_source, folder, path)


def _made(number: int, pose: int) -> Mesh:
    """Make a creature: the same body and coat for each pose, other triangles."""
    own, bent = random_of(SEED, number), random_of(SEED, number, pose)
    kind = sorted(KINDS)[number % len(KINDS)]
    shell = make_creature(
        kind,
        random_coat(own),
        random_pose(kind, bent) if pose else None,
        proportions=random_proportions(own),
        n_vertices=int(bent.integers(4000, 8000)),
        offset=float(bent.uniform()),
    )
    return read_mesh(Upload(files={"made.ply": ply_bytes(shell)}))


def _formed(read: Read, form: str, variant: Variant) -> Mesh:
    return FORMS[form](read(), random_of(variant.name))


def _cut(read: Read, variant: Variant) -> Mesh:
    return cut_away(read(), variant.cut, random_of(variant.name))


def exported(mesh: Mesh, random: np.random.Generator) -> Mesh:
    """Write a mesh as OBJ with colours at its vertices: turned, scaled, in another order, and read it."""
    vertices, faces, colours = _with_colours(mesh)
    order = random.permutation(len(vertices))
    places = np.argsort(order)
    moved = vertices[order] @ _turn(random).T * random.uniform(0.01, 100.0)
    corners = places[faces][random.permutation(len(faces))] + 1
    lines = [
        "v {:.7g} {:.7g} {:.7g} {:.4f} {:.4f} {:.4f}".format(*moved[i], *colours[order[i]])
        for i in range(len(order))
    ]
    lines += ["f {} {} {}".format(*corner) for corner in corners]
    return read_mesh(Upload(files={"exported.obj": "\n".join(lines).encode()}))


def subdivided(mesh: Mesh, _: np.random.Generator) -> Mesh:
    """Halve the longer half of the edges, until they are as short as the others."""
    vertices, faces, colours = _with_colours(mesh)
    finest = edge_of(float(face_areas(vertices, faces).sum()), FINEST)
    longest = max(float(np.median(edge_lengths(vertices, faces))), finest)
    faint = FAINT * longest  # colours are averaged with the positions, and make no edge longer
    joint, faces = split_long_edges(np.hstack([vertices, faint * colours]), faces, longest)
    return _mesh(joint[:, :3], faces, joint[:, 3:] / faint)


def coarser(mesh: Mesh, _: np.random.Generator) -> Mesh:
    """Merge the vertices in each cube of a grid."""
    return _mesh(*cluster(*_with_colours(mesh), CUBES))


def _plain(mesh: Mesh, _: np.random.Generator) -> Mesh:
    return mesh


FORMS: dict[str, Callable[[Mesh, np.random.Generator], Mesh]] = {
    "plain": _plain,
    "exported": exported,
    "subdivided": subdivided,
    "coarser": coarser,
}


def _with_colours(mesh: Mesh) -> tuple[FloatArray, IntArray, FloatArray]:
    """Return a mesh with its colours at vertices, doubled where faces meet in different colours."""
    corners = np.hstack([mesh.faces.reshape(-1, 1), np.rint(255 * mesh.corner_colours.reshape(-1, 3))])
    found, numbers = np.unique(corners.astype(np.int64), axis=0, return_inverse=True)
    return mesh.vertices[found[:, 0]], numbers.reshape(-1, 3), found[:, 1:] / 255.0


def _mesh(vertices: FloatArray, faces: IntArray, colours: FloatArray) -> Mesh:
    return Mesh(
        vertices=vertices,
        faces=faces,
        corner_colours=colours[faces],
        corner_uvs=np.zeros((len(faces), 3, 2)),
        face_textures=np.full(len(faces), -1),
        textures=(),
        colour=Colour.VERTEX,
        warnings=(),
    )


def _turn(random: np.random.Generator) -> FloatArray:
    """Draw a rotation: the orthogonal factor of normal numbers, made proper."""
    turn, triangle = np.linalg.qr(random.standard_normal((3, 3)))
    turn = turn * np.sign(np.diag(triangle))
    return np.asarray(turn * np.sign(np.linalg.det(turn)))
