"""Relations as they leave as JSON."""

from typing import Self

from pydantic import BaseModel, ConfigDict, Field
from pydantic.config import JsonDict

from service.relations.relation import Part, Related, Relation

EXAMPLE: JsonDict = {
    "name": "recoloured",
    "shape_distance": 0.001,
    "colour_distance": 0.84,
    "pattern_distance": 0.31,
    "pose_distance": 0.03,
    "misfit": 0.8,
    "part": None,
}


class RelationModel(BaseModel):
    """What one shape is to another, with its evidence; but for `part` the same in both directions."""

    model_config = ConfigDict(json_schema_extra={"example": EXAMPLE})

    name: Relation = Field(
        description="same_file: the same mesh file, and no difference; same_shape: exported or meshed anew; "
        "recoloured: the same shape and pose in other colours; re_posed: the same shape and colours in "
        "another pose; part_of: one is what is left of the other; similar: none of these"
    )
    shape_distance: float = Field(
        ge=0, description="share of the surface that is shaped otherwise, whatever the pose; 0 … 1"
    )
    colour_distance: float = Field(
        ge=0, description="share of the surface whose colours the other lacks; 0 … 1"
    )
    pattern_distance: float = Field(
        ge=0, description="difference of the colours by place, with light taken out; 0 … 2, 1 is unrelated"
    )
    pose_distance: float | None = Field(
        description="by how much points lie nearer or further apart on average, in centimetres on a surface "
        "of 1.9 m²; null where the shapes are not the same"
    )
    misfit: float | None = Field(
        description="how far apart the surfaces lie, laid on each other as well as can be, the worst "
        "twentieth left out, in the same unit; null where that decides nothing"
    )
    part: Part | None = Field(description="which of the two is a part of the other; null otherwise")

    @classmethod
    def of(cls, related: Related) -> Self:
        """Return a relation as it leaves."""
        evidence = related.evidence
        return cls(
            name=related.relation,
            shape_distance=evidence.shape_distance,
            colour_distance=evidence.colour_distance,
            pattern_distance=evidence.pattern_distance,
            pose_distance=evidence.pose_distance,
            misfit=evidence.misfit,
            part=evidence.part,
        )
