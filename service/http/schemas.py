"""What leaves and enters as JSON: the only place for pydantic models of the interface."""

from datetime import datetime
from typing import Any, Self

from pydantic import BaseModel, ConfigDict, Field
from pydantic.config import JsonDict

from index.methods import LooksAt, Method
from index.shapes import Page, Shape, Status, StoredFile
from service.http.reasons import FAILURES
from service.http.relation_schemas import RelationModel
from service.http.renewal_schemas import RenewalModel
from service.remembering import Remembered
from service.retrieval import Answer, Asked, Hit
from worker.describe import MeshFacts

EXAMPLE_SHAPE: JsonDict = {
    "id": "0b9c5e7f2a1d4c3e8f6a7b8c9d0e1f2a",
    "name": "amphora",
    "status": "ready",
    "created_at": "2026-03-01T09:30:00Z",
    "updated_at": "2026-03-01T09:30:04Z",
    "metadata": {"period": "late archaic"},
    "sha256": "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08",
    "mesh": {
        "vertices": 4210,
        "faces": 8416,
        "components": 1,
        "area": 0.418,
        "colour": "texture",
        "warnings": [],
    },
    "error": None,
    "files": [{"name": "amphora.ply", "size": 301722, "sha256": "2c26b46b68ffc68ff99b453c1d304134"}],
}


class MeshModel(BaseModel):
    """What was found out about the mesh, in the file's own unit."""

    vertices: int
    faces: int
    components: int
    area: float
    colour: str = Field(description="texture, vertex, face, material or none")
    warnings: list[str]

    @classmethod
    def of(cls, facts: MeshFacts) -> Self:
        """Return the facts of a mesh that is not kept."""
        return cls.model_validate(facts, from_attributes=True)


class FailureModel(BaseModel):
    """Why a shape failed."""

    code: str = Field(
        description="stable; the same codes as in a reply that refuses a mesh",
        json_schema_extra={"enum": list(FAILURES)},
    )
    detail: str


class FileModel(BaseModel):
    """One file as uploaded."""

    name: str
    size: int = Field(description="bytes")
    sha256: str

    @classmethod
    def of(cls, file: StoredFile) -> Self:
        """Return a file without where it is kept."""
        return cls(name=file.name, size=file.size, sha256=file.sha256)


class ShapeModel(BaseModel):
    """A shape."""

    model_config = ConfigDict(json_schema_extra={"example": EXAMPLE_SHAPE})

    id: str
    name: str
    status: Status
    created_at: datetime
    updated_at: datetime
    metadata: dict[str, Any]
    sha256: str = Field(description="of the whole upload: names, contents and allow_untextured")
    mesh: MeshModel | None = Field(description="null until the shape is ready")
    error: FailureModel | None = Field(description="why it failed; null otherwise")
    files: list[FileModel]

    @classmethod
    def of(cls, shape: Shape) -> Self:
        """Return a shape as it leaves."""
        failed = shape.error_code is not None
        return cls(
            id=shape.id,
            name=shape.name,
            status=shape.status,
            created_at=shape.created_at,
            updated_at=shape.updated_at,
            metadata=dict(shape.metadata),
            sha256=shape.sha256,
            mesh=MeshModel.model_validate(shape.facts) if shape.facts else None,
            error=FailureModel(code=shape.error_code or "", detail=shape.error_detail or "")
            if failed
            else None,
            files=[FileModel.of(file) for file in shape.files],
        )


class ShapesModel(BaseModel):
    """A page of shapes, newest first."""

    items: list[ShapeModel]
    next_cursor: str | None = Field(description="give it back as `cursor` for the next page; null at the end")

    @classmethod
    def of(cls, page: Page) -> Self:
        """Return a page as it leaves."""
        return cls(items=[ShapeModel.of(shape) for shape in page.items], next_cursor=page.next_cursor)


class ShapeChange(BaseModel):
    """What may be changed about a shape."""

    model_config = ConfigDict(
        extra="forbid", json_schema_extra={"example": {"name": "amphora 12", "metadata": {"room": "3"}}}
    )

    name: str | None = Field(default=None, description="a new name")
    metadata: dict[str, Any] | None = Field(default=None, description="replaces all metadata")


class ResultModel(BaseModel):
    """One result."""

    rank: int
    distance: float
    shape: ShapeModel
    relation: RelationModel | None = Field(
        description="what the shape is to the query; null unless `relations=true` asks for it, with other "
        "methods than the default and with own weights, beyond the first results that the method compares a "
        "second time (`refined` of `/v1/methods`), and where the shape's preview is gone"
    )

    @classmethod
    def of(cls, hit: Hit) -> Self:
        """Return a hit as it leaves."""
        return cls(
            rank=hit.rank,
            distance=hit.distance,
            shape=ShapeModel.of(hit.shape),
            relation=RelationModel.of(hit.relation) if hit.relation else None,
        )


class QueryModel(BaseModel):
    """A mesh that is no shape of the library."""

    id: str | None = Field(description="for `/v1/queries`; null unless it is remembered")
    name: str
    mesh: MeshModel

    @classmethod
    def of(cls, asked: Asked) -> Self:
        """Return a query as it leaves."""
        return cls(id=asked.id, name=asked.name, mesh=MeshModel.of(asked.facts))


class RememberedModel(BaseModel):
    """A query that is remembered."""

    id: str
    name: str
    mesh: MeshModel
    expires_at: datetime

    @classmethod
    def of(cls, query: Remembered) -> Self:
        """Return a remembered query as it leaves."""
        return cls(id=query.id, name=query.name, mesh=MeshModel.of(query.facts), expires_at=query.expires_at)


class AnswerModel(BaseModel):
    """A ranked answer, nearest first; equal distances by id."""

    method: str
    took_ms: float
    results: list[ResultModel]
    query: QueryModel | None = Field(default=None, description="of a mesh that is not kept")
    partly: RenewalModel | None = Field(
        default=None,
        description="while all shapes are described anew for a new version of the service: how many are and "
        "were compared with the query; null where all were",
    )
    exact: bool = Field(
        default=True,
        description="whether no nearer shape can be missing; false where a graph is searched (pgvector-hnsw)",
    )

    @classmethod
    def of(cls, answer: Answer) -> Self:
        """Return an answer as it leaves."""
        return cls(
            method=answer.method,
            took_ms=round(answer.milliseconds, 3),
            results=[ResultModel.of(hit) for hit in answer.hits],
            query=QueryModel.of(answer.query) if answer.query else None,
            partly=RenewalModel.of(answer.partly) if answer.partly else None,
            exact=answer.exact,
        )


class BlockModel(BaseModel):
    """One block of a method's distance."""

    name: str
    weight: float
    power: int = Field(description="the L1 distance of the block is raised to it")
    looks_at: LooksAt


class MethodModel(BaseModel):
    """A method: distance = Σ weight · (L1 distance of block) ** power."""

    name: str
    description: str
    default: bool
    refined: int = Field(description="How many of the first results are compared a second time, more closely")
    blocks: list[BlockModel]

    @classmethod
    def of(cls, method: Method, *, default: bool) -> Self:
        """Return a method as it leaves."""
        blocks = [BlockModel.model_validate(block, from_attributes=True) for block in method.blocks]
        return cls(
            name=method.name,
            description=method.description,
            default=default,
            refined=method.refined,
            blocks=blocks,
        )


class MethodsModel(BaseModel):
    """All methods."""

    items: list[MethodModel]
    next_cursor: None = None


class DescriptorsModel(BaseModel):
    """The numbers of a shape."""

    vocabulary: str = Field(description="the vocabulary that the words of the blocks belong to")
    fingerprint: str = Field(description="of the parameters; numbers of two fingerprints are not comparable")
    blocks: dict[str, list[float]]
    eigenvalues: dict[str, list[float]] = Field(description="by colour weight η, per unit of scaled area")


class ProblemModel(BaseModel):
    """An error, after RFC 9457."""

    model_config = ConfigDict(
        json_schema_extra={
            "example": {
                "type": "urn:faience:problem:missing_texture",
                "title": "The mesh is refused",
                "status": 422,
                "detail": "amphora.mtl names clay.png, which was not sent",
                "code": "missing_texture",
                "request_id": "7f0c8a4e0f6d4a4e9a0e6d5c2b1a9f83",
            }
        }
    )

    type: str
    title: str
    status: int
    detail: str
    code: str = Field(description="stable; see the list of codes")
    request_id: str | None = Field(
        default=None, description="as in `X-Request-ID`; the service's log names it. Not of what is no HTTP."
    )
    parts: dict[str, str] | None = Field(
        default=None, description="of `unready`: each part of the service, and `ok` or what is wrong with it"
    )
