"""Explanations as they leave as JSON."""

from typing import Self

from pydantic import BaseModel, ConfigDict, Field
from pydantic.config import JsonDict

from index.methods import LooksAt
from service.why.explaining import Explanation, Part

EXAMPLE: JsonDict = {
    "method": "fused",
    "distance": 1.099,
    "blocks": [
        {
            "name": "log-hks",
            "looks_at": "geometry",
            "weight": 1.704,
            "distance": 0.006,
            "contribution": 0.011,
            "share": 0.01,
            "placed": 1.0,
        }
    ],
    "scale": 1.96,
}


class WhyBlockModel(BaseModel):
    """What one block adds to a distance."""

    name: str
    looks_at: LooksAt
    weight: float
    distance: float = Field(ge=0, description="L1 distance of the block")
    contribution: float = Field(ge=0, description="weight · distance ** power")
    share: float = Field(ge=0, le=1, description="of the whole distance")
    placed: float = Field(
        ge=0,
        le=1,
        description="the part of the contribution that could be put somewhere on the surfaces; colours finer "
        "than the meshes shown have no place",
    )

    @classmethod
    def of(cls, part: Part, share: float) -> Self:
        """Return a part as it leaves."""
        return cls(
            name=part.block.name,
            looks_at=part.block.looks_at,
            weight=part.block.weight,
            distance=part.distance,
            contribution=part.contribution,
            share=share,
            placed=part.placed,
        )


class WhyModel(BaseModel):
    """Why two shapes lie as far apart as they do: distance = Σ contribution of blocks."""

    model_config = ConfigDict(json_schema_extra={"example": EXAMPLE})

    method: str
    distance: float = Field(
        ge=0,
        description="of the blocks alone: what a second comparison of the first results adds is not in it",
    )
    blocks: list[WhyBlockModel]
    scale: float = Field(
        gt=0,
        description="contribution per share of the surface's area that the strongest colour shows, the same "
        "in query.glb and result.glb",
    )

    @classmethod
    def of(cls, explanation: Explanation) -> Self:
        """Return an explanation as it leaves."""
        return cls(
            method=explanation.method,
            distance=explanation.distance,
            blocks=[WhyBlockModel.of(part, explanation.share(part)) for part in explanation.parts],
            scale=explanation.scale,
        )
