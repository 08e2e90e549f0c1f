"""The library at a glance, as it leaves as JSON."""

from collections.abc import Mapping
from datetime import datetime
from typing import Self

from pydantic import BaseModel, Field

from index.progress import QueueProgress
from index.renewals import RenewalProgress
from index.shapes import Status
from index.tags import TagPage
from service.http.renewal_schemas import RenewalModel


class TagModel(BaseModel):
    """A tag, and how often it is used."""

    tag: str
    shapes: int


class TagsModel(BaseModel):
    """A page of tags, the most used first."""

    items: list[TagModel]
    next_cursor: str | None = Field(description="give it back as `cursor` for the next page; null at the end")

    @classmethod
    def of(cls, page: TagPage) -> Self:
        """Return a page as it leaves."""
        items = [TagModel(tag=tag.name, shapes=tag.shapes) for tag in page.items]
        return cls(items=items, next_cursor=page.next_cursor)


class CountsModel(BaseModel):
    """Numbers of shapes by state."""

    total: int
    queued: int
    processing: int
    ready: int
    failed: int

    @classmethod
    def of(cls, counts: Mapping[Status, int]) -> Self:
        """Return numbers as they leave."""
        return cls(total=sum(counts.values()), **{status.value: number for status, number in counts.items()})


class WorkerModel(BaseModel):
    """One worker."""

    name: str
    jobs: int = Field(description="that it has in hand")


class FinishedModel(BaseModel):
    """Jobs that ended lately, well or not."""

    last_minute: int
    last_hour: int


class QueueModel(BaseModel):
    """How far the queue is."""

    queued: int = Field(description="jobs that wait")
    processing: int = Field(description="jobs that a worker has in hand")
    failed: int = Field(description="shapes that could not be described")
    oldest_queued_at: datetime | None = Field(description="when the job that waits longest was queued")
    workers: list[WorkerModel] = Field(
        description="those that have jobs in hand, also of shapes that are described anew"
    )
    finished: FinishedModel
    median_seconds: float | None = Field(description="that a job took in the last hour; null without any")
    expected_seconds: float | None = Field(
        description="until the queue is empty, at the speed of the last five minutes; null where unknown"
    )
    renewal: RenewalModel | None = Field(
        description="how far all shapes are described anew for a new version; null where they are not"
    )

    @classmethod
    def of(
        cls, progress: QueueProgress, counts: Mapping[Status, int], renewal: RenewalProgress | None
    ) -> Self:
        """Return the queue as it leaves."""
        return cls(
            queued=progress.queued,
            processing=progress.processing,
            failed=counts[Status.FAILED],
            oldest_queued_at=progress.oldest_queued_at,
            workers=[WorkerModel(name=name, jobs=jobs) for name, jobs in progress.held.items()],
            finished=FinishedModel(last_minute=progress.last_minute, last_hour=progress.last_hour),
            median_seconds=progress.median_seconds,
            expected_seconds=progress.expected_seconds,
            renewal=None if renewal is None else RenewalModel.of(renewal),
        )
