"""Relations of two shapes, and the numbers by which they are told."""

from dataclasses import dataclass
from enum import StrEnum


class Relation(StrEnum):
    """What one shape is to another, the closest first."""

    SAME_FILE = "same_file"  # the same mesh file, and nothing differs
    SAME_SHAPE = "same_shape"  # exported or meshed anew: shape, pose and colours are the same
    RECOLOURED = "recoloured"  # shape and pose are the same, colours are not
    RE_POSED = "re_posed"  # shape and colours are the same, the pose is not
    PART_OF = "part_of"  # one is what was left of the other
    SIMILAR = "similar"  # none of these


class Part(StrEnum):
    """Which of two shapes is a part of the other."""

    QUERY = "query"
    RESULT = "result"


@dataclass(frozen=True, kw_only=True)
class Evidence:
    """How far two shapes are apart; but for ``part`` the same whichever of them is the query."""

    shape_distance: float  # share of the surface, 0…1, on which heat spreads otherwise, whatever the pose
    colour_distance: float  # share of the surface, 0…1, whose colours the other lacks
    pattern_distance: float  # of the colours by place, light taken out: 0 the same, about 1 unrelated
    pose_distance: (
        float | None
    )  # mean change of the distances between points, units; None: not the same shape
    misfit: float | None  # units that they lie apart, laid on each other; None where that was not tried
    part: Part | None  # which of them the other holds
    same_file: bool  # both were sent with the same mesh file


@dataclass(frozen=True, kw_only=True)
class Related:
    """A relation with its evidence."""

    relation: Relation
    evidence: Evidence
