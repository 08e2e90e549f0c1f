"""Evidence: the numbers between two shapes, the cheap ones first, the others where they can decide."""

from dataclasses import replace

import numpy as np

from service.relations.deciding import PART_FITS, POSE, SHAPE, relation_of
from service.relations.relation import Evidence, Part, Related
from service.relations.sides import CURVES, HISTOGRAM, WORDS, Side, apart
from worker.arrays import SingleArray
from worker.descriptors.alignment import misfit
from worker.descriptors.containment import gap
from worker.descriptors.posture import posture_distance

UNRELATED = 150.0  # L1 distance of the colour curves of shapes that have nothing to do with each other
LEAST, MOST = 0.2, 0.97  # area of a part, as a share of the whole's
HELD = 0.95  # of a part's colours that the whole must have, as much of each


def relate_sides(query: Side, result: Side, *, parts: bool = True) -> Related | None:
    """Return how two shapes are related; None where a preview that is needed is gone, or cannot be read.

    Parameters
    ----------
    parts : bool
        Whether to look for parts; without, they are only similar.
    """
    evidence = Evidence(
        shape_distance=apart(query, result, WORDS) / 2.0,
        colour_distance=apart(query, result, HISTOGRAM) / 2.0,
        pattern_distance=apart(query, result, CURVES) / UNRELATED,
        pose_distance=None,
        misfit=None,
        part=None,
        same_file=bool(query.mesh_files & result.mesh_files),
    )
    found: Evidence | None = evidence
    if evidence.shape_distance <= SHAPE:
        found = _posed(query, result, evidence)
    elif parts:
        found = _parted(query, result, evidence)
    return None if found is None else Related(relation=relation_of(found), evidence=found)


def _posed(query: Side, result: Side, evidence: Evidence) -> Evidence | None:
    """Compare the poses of what is one surface; lay them on each other where they may be the same."""
    own, other = query.posture(), result.posture()
    if own is None or other is None:
        return None
    found = replace(evidence, pose_distance=posture_distance(own, other))
    if posture_distance(own, other) >= POSE:
        return found
    if query.placed is None or result.placed is None:
        return None
    return replace(found, misfit=misfit(query.placed, result.placed))


def _parted(query: Side, result: Side, evidence: Evidence) -> Evidence | None:
    """Look whether the smaller one is a part of the other: of its colours, and lying on it."""
    smaller, larger = sorted((query, result), key=lambda side: side.area)
    share = smaller.area / larger.area if larger.area > 0.0 else 0.0
    if not LEAST <= share <= MOST:
        return evidence
    if _held(smaller.blocks[HISTOGRAM], larger.blocks[HISTOGRAM], share) < HELD:
        return evidence
    if smaller.placed is None or larger.placed is None:
        return None
    left = gap(smaller.placed, larger.placed, float(np.sqrt(share)))
    if left > PART_FITS:
        return evidence
    return replace(evidence, misfit=left, part=Part.QUERY if smaller is query else Part.RESULT)


def _held(part: SingleArray, whole: SingleArray, share: float) -> float:
    """Return how much, 0…1, of the colours of a part the whole has, where the part is a share of it."""
    tiny = float(np.finfo(np.float32).tiny)
    own, other = share * part / max(float(part.sum()), tiny), whole / max(float(whole.sum()), tiny)
    return 1.0 - float(np.maximum(own - other, 0.0).sum()) / share
