"""A typed client of Faience, the search engine for coloured 3D shapes."""

from faience_client.client import Faience
from faience_client.errors import FaienceError, NotReached, Refused
from faience_client.events import Changed, Removed
from faience_client.models import (
    Answer,
    Counts,
    Descriptors,
    Dismissal,
    Group,
    Method,
    Query,
    Queue,
    Relation,
    RememberedQuery,
    Renewal,
    Result,
    Shape,
    Status,
    Tag,
    Why,
)

__all__ = [
    "Answer",
    "Changed",
    "Counts",
    "Descriptors",
    "Dismissal",
    "Faience",
    "FaienceError",
    "Group",
    "Method",
    "NotReached",
    "Query",
    "Queue",
    "Refused",
    "Relation",
    "RememberedQuery",
    "Removed",
    "Renewal",
    "Result",
    "Shape",
    "Status",
    "Tag",
    "Why",
]
