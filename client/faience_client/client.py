"""Faience: one service, its calls as methods."""

from types import TracebackType
from typing import Self

from faience_client.answers import Answers
from faience_client.connection import Connection
from faience_client.duplicates import Duplicates
from faience_client.overview import Overview
from faience_client.shapes import Shapes

PATIENCE = 60.0  # seconds


class Faience(Shapes, Answers, Duplicates, Overview):
    """A client of one service; safe to share between threads.

    Parameters
    ----------
    address : str
        Where it is, such as ``http://127.0.0.1:8000``.
    key : str, optional
        Where it asks for one.
    patience : float
        Seconds in which a call is tried again while the service restarts, is busy or cannot be reached.
    """

    def __init__(self, address: str, key: str | None = None, patience: float = PATIENCE) -> None:
        self._service = Connection(address, key, patience)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Let go of the connections."""
        self._service.close()
