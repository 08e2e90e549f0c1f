"""Uploads as nobody should send them: cut, stalled, and all at once."""

from dataclasses import dataclass

from soak.crowd import CrowdFigures, concurrent_uploads
from soak.cut import CutFigures, cut_uploads, last_cut, seams
from soak.parcels import parcel
from soak.stalled import StallFigures, stalled_clients
from soak.target import Target, form

TEXTURED = 499_999  # a parcel of an OBJ with its MTL and its picture
RELEASE_SECONDS = 75.0  # the longest of the service's own patience is a minute


@dataclass(frozen=True, kw_only=True)
class UploadFigures:
    """What came of all three."""

    cut: CutFigures
    stalled: StallFigures
    crowd: CrowdFigures


def rude_uploads(target: Target, *, every: int = 1, stalled: int = 20, crowd: int = 200) -> UploadFigures:
    """Cut an upload at many offsets, stall clients, send many uploads at once.

    Parameters
    ----------
    every : int
        Bytes between two cuts; around the seams of the form there is one at each byte.
    stalled, crowd : int
        Clients that stall, and uploads at the same time.

    Raises
    ------
    AssertionError
        With the promise that was broken.
    """
    body = form(parcel(TEXTURED))
    offsets = sorted({*seams(body), *range(0, last_cut(body) + 1, every)})
    return UploadFigures(
        cut=cut_uploads(target, body, offsets),
        stalled=stalled_clients(target, stalled, requests=20, release_seconds=RELEASE_SECONDS),
        crowd=concurrent_uploads(target, crowd, copies=4),
    )
