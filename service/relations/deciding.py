"""Deciding: which relation two shapes have, by the numbers between them.

docs/relations.md tells what the limits were chosen on, and how well they hold on other shapes.
"""

from service.relations.relation import Evidence, Relation

SHAPE = 0.065  # shape distance up to which it is one surface, bent or not
COLOUR = 0.035  # colour distance up to which colours are the same
PATTERN = 0.45  # pattern distance up to which they are in the same places
POSE = 0.35  # pose distance, units, from which on the pose is another; below, surfaces are laid on each other
FITS = 2.0  # misfit, units, up to which the pose is the same
BENT = 3.0  # and from which on it is another; between the two, nothing is said
PART_FITS = 1.3  # misfit, units, up to which a part was cut from a whole


def relation_of(evidence: Evidence) -> Relation:
    """Return the closest relation that the numbers bear out."""
    same_colours = evidence.colour_distance <= COLOUR and evidence.pattern_distance <= PATTERN
    if evidence.part is not None:
        return Relation.PART_OF
    if evidence.pose_distance is None:
        return Relation.SIMILAR
    misfit = evidence.misfit
    if misfit is not None and misfit <= FITS:
        return _unbent(evidence) if same_colours else Relation.RECOLOURED
    bent = misfit is None or misfit >= BENT
    return Relation.RE_POSED if bent and same_colours else Relation.SIMILAR


def _unbent(evidence: Evidence) -> Relation:
    differs = evidence.shape_distance or evidence.colour_distance or evidence.pattern_distance
    return Relation.SAME_FILE if evidence.same_file and not differs else Relation.SAME_SHAPE
