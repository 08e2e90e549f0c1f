"""The truth about pairs of meshes: the relation that they were made to have, or none that can be named."""

from collections.abc import Mapping
from functools import cache
from itertools import combinations

import numpy as np
from scipy.spatial import cKDTree

from benchmarks.relation_meshes import Read, Variant
from service.relations.relation import Relation
from worker.arrays import FloatArray, IntArray
from worker.geometry.repair import repair
from worker.geometry.resampling import normalise_area, sample_surface
from worker.parameters import Parameters

DENSE, SPARSE = 40_000, 2_000  # points of a surface, near which points of another are looked for
KEPT = 0.8  # of the points decide how one is laid on the other
ROUNDS = 30  # of iterated closest points, from where the files put the two
APART = 0.95  # of the points lie nearer than what counts as moved
STILL, MOVED = 1.5, 3.0  # units up to which two poses are one, and from which on they are two
SEEN = 2.3  # Lab units: a smaller change of colour is not noticed (Mahy et al. 1994)
ALIASES = {  # models that are one surface in two colours
    "q_animals__Horse_White": "q_animals__Horse",
    "mh_11_female_cauc_suitskin": "mh_08_female_cauc_casual1",
    "q_cute_fish__MandarinFish": "q_cute_fish__RoyalGramma",
}

Moves = Mapping[frozenset[tuple[str, str]], float]  # of two (model, pose): units that points moved


def truth(one: Variant, other: Variant, changes: Mapping[Variant, float], moves: Moves) -> Relation | None:
    """Return how two meshes are related; None where that is a matter of taste."""
    if one == other:
        return Relation.SAME_FILE
    if _surface(one) != _surface(other):
        return Relation.SIMILAR
    if one.cut or other.cut:
        return _cut_truth(one, other)
    moved = moves[frozenset({(one.model, one.pose), (other.model, other.pose)})] if _bent(one, other) else 0.0
    coloured = _recoloured(one, other, changes)
    if coloured is None or STILL < moved < MOVED:
        return None
    if moved <= STILL:
        return Relation.RECOLOURED if coloured else Relation.SAME_SHAPE
    return Relation.SIMILAR if coloured else Relation.RE_POSED


def _surface(variant: Variant) -> str:
    return ALIASES.get(variant.model, variant.model)


def _bent(one: Variant, other: Variant) -> bool:
    return one.pose != other.pose or one.model != other.model


def _cut_truth(one: Variant, other: Variant) -> Relation | None:
    if (one.cut and other.cut) or one.model != other.model or one.pose != other.pose:
        return None
    return Relation.PART_OF if one.coat == other.coat else None


def _recoloured(one: Variant, other: Variant, changes: Mapping[Variant, float]) -> bool | None:
    """Return whether colours differ; None where nobody would see it, or where it is not known."""
    if one.model != other.model:
        return True if one.coat == other.coat == "own" else None
    if one.coat == other.coat:
        return False
    if "own" not in (one.coat, other.coat):
        return None
    return True if max(changes[one], changes[other]) >= SEEN else None


def moves_of(poses: Mapping[tuple[str, str], Read]) -> dict[frozenset[tuple[str, str]], float]:
    """Return how far the points of a model move between its poses, and to those of its aliases."""

    @cache
    def points(pose: tuple[str, str]) -> tuple[FloatArray, FloatArray]:
        repaired = repair(poses[pose]())
        vertices = normalise_area(repaired.vertices, repaired.faces, Parameters().surface_area)
        return _sampled(vertices, repaired.faces, SPARSE), _sampled(vertices, repaired.faces, DENSE)

    return {
        frozenset({one, other}): max(
            _moved(*points(one), *points(other)), _moved(*points(other), *points(one))
        )
        for one, other in combinations(poses, 2)
    }


def _sampled(vertices: FloatArray, faces: IntArray, count: int) -> FloatArray:
    chosen, places = sample_surface(vertices, faces, count)
    return np.asarray(np.einsum("pc,pcx->px", places, vertices[faces[chosen]]))


def _moved(points: FloatArray, _: FloatArray, __: FloatArray, goal: FloatArray) -> float:
    """Lay points on a surface by turning and shifting; return how far all but a twentieth lie at most."""
    tree = cKDTree(goal)
    for _round in range(ROUNDS):
        distances, places = tree.query(points)
        kept = distances <= np.quantile(distances, KEPT)
        here, there = points[kept], goal[np.asarray(places)[kept]]
        left, _singular, right = np.linalg.svd((here - here.mean(0)).T @ (there - there.mean(0)))
        proper = np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
        points = (points - here.mean(0)) @ left @ proper @ right + there.mean(0)
    return float(np.quantile(tree.query(points)[0], APART))
