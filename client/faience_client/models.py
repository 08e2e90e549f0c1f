"""What the service answers with, as values; what a later service adds is left out."""

from datetime import datetime
from enum import StrEnum
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict

LooksAt = Literal["geometry", "colour", "both"]


class Status(StrEnum):
    """How far a shape has come."""

    QUEUED = "queued"
    PROCESSING = "processing"
    READY = "ready"
    FAILED = "failed"


class Relation(StrEnum):
    """What one shape is to another, the closest first."""

    SAME_FILE = "same_file"
    SAME_SHAPE = "same_shape"
    RECOLOURED = "recoloured"
    RE_POSED = "re_posed"
    PART_OF = "part_of"
    SIMILAR = "similar"


class _Model(BaseModel):
    model_config = ConfigDict(frozen=True, extra="ignore")


class Mesh(_Model):
    """What was found out about a mesh, in the file's own unit."""

    vertices: int
    faces: int
    components: int
    area: float
    colour: str  # texture, vertex, face, material or none
    warnings: list[str]


class Failure(_Model):
    """Why a shape failed."""

    code: str
    detail: str


class File(_Model):
    """One file as uploaded."""

    name: str
    size: int  # bytes
    sha256: str


class Shape(_Model):
    """A shape of the library."""

    id: str
    name: str
    status: Status
    created_at: datetime
    updated_at: datetime
    metadata: dict[str, Any]
    sha256: str  # of the whole upload
    mesh: Mesh | None  # None until it is ready
    error: Failure | None
    files: list[File]


class Evidence(_Model):
    """What a shape is to another, with the numbers that decide."""

    name: Relation
    shape_distance: float
    colour_distance: float
    pattern_distance: float
    pose_distance: float | None
    misfit: float | None
    part: Literal["query", "result"] | None


class Result(_Model):
    """One result of an answer."""

    rank: int  # from 1
    distance: float  # of the method
    shape: Shape
    relation: Evidence | None  # where it was asked for


class Query(_Model):
    """A mesh that was asked about and is no shape of the library."""

    id: str | None  # None unless it is remembered
    name: str
    mesh: Mesh


class RememberedQuery(Query):
    """The same, remembered for a while."""

    id: str
    expires_at: datetime


class Renewal(_Model):
    """Shapes that are described anew for a new version of the service."""

    done: int
    failed: int
    total: int


class Answer(_Model):
    """A ranked answer, nearest first."""

    method: str
    took_ms: float
    results: list[Result]
    query: Query | None = None
    partly: Renewal | None = None  # with how many it was compared, while all are described anew
    exact: bool = True  # whether no nearer shape can be missing


class Block(_Model):
    """One block of a method's distance."""

    name: str
    weight: float
    power: int
    looks_at: LooksAt


class Method(_Model):
    """A method: distance = Σ weight · (L1 distance of block) ** power."""

    name: str
    description: str
    default: bool
    refined: int  # of the first results, compared a second time
    blocks: list[Block]


class Descriptors(_Model):
    """The numbers of a shape."""

    vocabulary: str
    fingerprint: str  # numbers of two fingerprints are not comparable
    blocks: dict[str, list[float]]
    eigenvalues: dict[str, list[float]]


class Tag(_Model):
    """A tag, and how many shapes have it."""

    tag: str
    shapes: int


class Counts(_Model):
    """Shapes by status."""

    total: int
    queued: int
    processing: int
    ready: int
    failed: int


class Worker(_Model):
    """Who works, on how many jobs."""

    name: str
    jobs: int


class Finished(_Model):
    """Jobs that ended lately."""

    last_minute: int
    last_hour: int


class Queue(_Model):
    """What waits and what runs."""

    queued: int
    processing: int
    failed: int
    oldest_queued_at: datetime | None
    workers: list[Worker]
    finished: Finished
    median_seconds: float | None
    expected_seconds: float | None
    renewal: Renewal | None = None


class Pair(_Model):
    """Two shapes that are duplicates, and why."""

    one: str
    other: str
    relation: Evidence


class Group(_Model):
    """Shapes that are duplicates of each other."""

    id: str  # the same as long as the group has the same shapes
    relation: Relation  # the loosest that joins two of them
    shapes: list[Shape]
    evidence: list[Pair]


class Dismissal(_Model):
    """Two shapes that somebody called no duplicates."""

    one: str
    other: str
    created_at: datetime


class WhyBlock(_Model):
    """What one block adds to a distance."""

    name: str
    looks_at: LooksAt
    weight: float
    distance: float
    contribution: float
    share: float
    placed: float


class Why(_Model):
    """What the distance of two shapes is made of."""

    method: str
    distance: float
    blocks: list[WhyBlock]
    scale: float
