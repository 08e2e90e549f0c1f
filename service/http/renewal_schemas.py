"""How far it is that all shapes are described anew, as it leaves as JSON."""

from typing import Self

from pydantic import BaseModel, Field

from index.renewals import RenewalProgress


class RenewalModel(BaseModel):
    """Shapes that are described anew for a new version; searches answer from the earlier descriptions."""

    done: int = Field(description="shapes that have a new description")
    failed: int = Field(description="shapes that cannot get one; they answer as before until the end")
    total: int

    @classmethod
    def of(cls, progress: RenewalProgress) -> Self:
        """Return how far it is as it leaves."""
        return cls(done=progress.done, failed=progress.failed, total=progress.total)
