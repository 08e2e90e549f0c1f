"""Groups of duplicates, and what users dismissed, as they leave as JSON."""

from datetime import datetime
from typing import Self

from pydantic import BaseModel, ConfigDict, Field

from index.dismissals import Dismissal, DismissalPage
from service.http.relation_schemas import RelationModel
from service.http.schemas import ShapeModel
from service.relations.duplicates import Duplicates, DuplicatesPage
from service.relations.relation import Related, Relation

NEXT = "give it back as `cursor` for the next page; null at the end"


class PairModel(BaseModel):
    """Two shapes of a group, and what they are to each other."""

    one: str = Field(description="id of a shape, the lesser of the two")
    other: str = Field(description="id of a shape")
    relation: RelationModel

    @classmethod
    def of(cls, pair: tuple[str, str], related: Related) -> Self:
        """Return a pair as it leaves."""
        return cls(one=pair[0], other=pair[1], relation=RelationModel.of(related))


class GroupModel(BaseModel):
    """Shapes that are duplicates of each other, directly or by way of others among them."""

    id: str = Field(description="the same as long as the group has the same shapes")
    relation: Relation = Field(description="the loosest that joins two of them")
    shapes: list[ShapeModel]
    evidence: list[PairModel] = Field(description="the pairs that join them")

    @classmethod
    def of(cls, found: Duplicates) -> Self:
        """Return a group as it leaves."""
        group = found.group
        return cls(
            id=group.id,
            relation=group.relation,
            shapes=[ShapeModel.of(shape) for shape in found.shapes],
            evidence=[PairModel.of(pair, related) for pair, related in group.pairs.items()],
        )


class DuplicatesModel(BaseModel):
    """A page of groups; it may hold none while there are more pages."""

    items: list[GroupModel]
    looked: int = Field(description="how many shapes this page looked at: with those before, how far it is")
    next_cursor: str | None = Field(description=NEXT)

    @classmethod
    def of(cls, page: DuplicatesPage) -> Self:
        """Return a page as it leaves."""
        items = [GroupModel.of(found) for found in page.items]
        return cls(items=items, looked=page.looked, next_cursor=page.next_cursor)


class DismissalModel(BaseModel):
    """Two shapes that somebody said are no duplicates."""

    model_config = ConfigDict(
        json_schema_extra={
            "example": {
                "one": "0b9c5e7f2a1d4c3e8f6a7b8c9d0e1f2a",
                "other": "5d2e8c1b7a6f4039b1c2d3e4f5a6b7c8",
                "created_at": "2026-03-01T09:30:00Z",
            }
        }
    )

    one: str = Field(description="id of a shape, the lesser of the two")
    other: str = Field(description="id of a shape")
    created_at: datetime

    @classmethod
    def of(cls, dismissal: Dismissal) -> Self:
        """Return a dismissal as it leaves."""
        return cls(one=dismissal.one, other=dismissal.other, created_at=dismissal.created_at)


class DismissalsModel(BaseModel):
    """A page of dismissals, by ids."""

    items: list[DismissalModel]
    next_cursor: str | None = Field(description=NEXT)

    @classmethod
    def of(cls, page: DismissalPage) -> Self:
        """Return a page as it leaves."""
        return cls(items=[DismissalModel.of(item) for item in page.items], next_cursor=page.next_cursor)
