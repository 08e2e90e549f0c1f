"""Explaining: how much each block, and each vertex of two surfaces, adds to the distance of two shapes."""

from dataclasses import dataclass

import numpy as np

from index.methods import Block, Method
from index.vocabulary import Vocabulary
from service.why.placing import densities, difference
from service.why.scale import scale_of
from service.why.sides import Side
from worker.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Part:
    """What one block adds to a distance."""

    block: Block
    distance: float  # L1
    contribution: float  # weight · distance^power
    query: FloatArray  # (n,), what each vertex of the query adds to it, per share of the area
    result: FloatArray  # (m,), the same for the result
    placed: float  # the part of the contribution that these hold, 0…1


@dataclass(frozen=True, kw_only=True, eq=False)
class Explanation:
    """Why two shapes lie as far apart as they do."""

    method: str
    distance: float  # of the blocks alone
    parts: tuple[Part, ...]  # in the method's order
    scale: float  # density that the strongest colour shows, on both surfaces
    query: FloatArray  # (n,), what each vertex of the query adds to the distance, per share of the area
    result: FloatArray  # (m,), the same for the result

    def share(self, part: Part) -> float:
        """Return the share of a part in the whole distance, 0…1."""
        return part.contribution / self.distance if self.distance else 0.0


def explain(query: Side, result: Side, method: Method, vocabulary: Vocabulary) -> Explanation:
    """Split the distance of two shapes among blocks and vertices.

    Parameters
    ----------
    query, result : Side
        With the method's blocks.
    method : Method
        Of blocks that have places; perhaps with own weights.
    vocabulary : Vocabulary
        In whose words the blocks are.
    """
    parts = tuple(_part(query, result, block, vocabulary) for block in method.blocks)
    on_query = np.sum([part.query for part in parts], axis=0)
    on_result = np.sum([part.result for part in parts], axis=0)
    values, shares = np.concatenate([on_query, on_result]), np.concatenate([query.shares, result.shares])
    return Explanation(
        method=method.name,
        distance=sum(part.contribution for part in parts),
        parts=parts,
        scale=scale_of(values, shares, method),
        query=on_query,
        result=on_result,
    )


def _part(query: Side, result: Side, block: Block, vocabulary: Vocabulary) -> Part:
    distance = float(np.abs(difference(query, result, block.name)).sum())
    contribution = block.weight * distance**block.power
    on_query, on_result, placed = np.zeros(len(query.shares)), np.zeros(len(result.shares)), 1.0
    if contribution:
        factor = contribution / distance
        on_query = factor * densities(query, result, block.name, vocabulary)
        on_result = factor * densities(result, query, block.name, vocabulary)
        placed = float(query.shares @ on_query + result.shares @ on_result) / contribution
    return Part(
        block=block,
        distance=distance,
        contribution=contribution,
        query=on_query,
        result=on_result,
        placed=min(placed, 1.0),  # but for rounding it never is more
    )
