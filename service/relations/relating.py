"""Relating: a query and what was found for it."""

from collections.abc import Sequence

from service.library import Library
from service.relations.evidence import relate_sides
from service.relations.relation import Related
from service.relations.sides import Side, stored_sides


def relate_stored(
    library: Library, shape_id: str, others: Sequence[str], vocabulary_id: str, *, parts: bool = True
) -> dict[str, Related]:
    """Return how a stored shape is related to others, by their ids.

    Parameters
    ----------
    vocabulary_id : str
        In whose words the shapes are compared.
    parts : bool
        Whether to look for parts.

    Returns
    -------
    dict of id to Related
        Without those that cannot be compared: removed in this moment, or without a preview.
    """
    if not others:
        return {}
    sides = stored_sides(library, [shape_id, *others], vocabulary_id)
    own = sides.pop(shape_id, None)
    return {} if own is None else _all_related(own, sides, parts)


def relate(library: Library, query: Side, others: Sequence[str], vocabulary_id: str) -> dict[str, Related]:
    """Return how a mesh that is not kept is related to stored shapes; as `relate_stored`."""
    return _all_related(query, stored_sides(library, others, vocabulary_id), True) if others else {}


def _all_related(own: Side, others: dict[str, Side], parts: bool) -> dict[str, Related]:
    found = {shape_id: relate_sides(own, other, parts=parts) for shape_id, other in others.items()}
    return {shape_id: relation for shape_id, relation in found.items() if relation is not None}
