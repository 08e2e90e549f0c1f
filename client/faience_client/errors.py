"""What can go wrong, for those who ask."""

from typing import Any


class FaienceError(Exception):
    """Any failure of a call."""


class NotReached(FaienceError):
    """The service did not answer, or only said that it is busy, for as long as the client is patient."""


class Refused(FaienceError):
    """The service answered that it will not do this.

    Attributes
    ----------
    status : int
        Of HTTP.
    code : str
        Stable; docs/errors.md of the service lists what each means and what to do.
    detail : str
        What was expected and what came, in words for people.
    repeated : bool
        Whether an earlier try of the same call may have been carried out, its answer lost.
    """

    repeated = False

    def __init__(self, status: int, code: str, title: str, detail: str) -> None:
        super().__init__(f"{title}: {detail} ({code})")
        self.status, self.code, self.title, self.detail = status, code, title, detail

    @classmethod
    def of(cls, status: int, body: Any) -> "Refused":
        """Return the error that a problem's JSON (RFC 9457) tells; of a stranger's answer, what is there."""
        told = body if isinstance(body, dict) else {}
        title = str(told.get("title") or "The call failed")
        return cls(status, str(told.get("code") or f"http_{status}"), title, str(told.get("detail") or body))
