"""Postures of stored shapes, read from their previews and remembered for a while."""

from collections import OrderedDict
from threading import Lock

import numpy as np

from index.errors import FileMissing
from index.files import FileStore
from service.storage import PREVIEW, derived_key
from worker.arrays import SingleArray
from worker.descriptors.posture import posture
from worker.pictures.preview_points import NoPreview, read_points
from worker.solving import areas_of

MOST = 4_096  # postures that are remembered, 4 kB each


class Postures:
    """The postures of a library's shapes; safe to share between threads."""

    def __init__(self) -> None:
        self._known: OrderedDict[str, SingleArray | None] = OrderedDict()
        self._lock = Lock()

    def of(
        self, files: FileStore, shape_id: str, revision: int, made_in: str | None = None
    ) -> SingleArray | None:
        """Return the posture of a ready shape; None where it has no preview that can be read.

        Parameters
        ----------
        revision : int
            Of the shape's last change: one that was described anew is read anew.
        made_in : str, optional
            Folder of its files; see `index.shapes.Shape`.
        """
        key = f"{shape_id}/{revision}/{made_in}"
        with self._lock:
            if key in self._known:
                self._known.move_to_end(key)
                return self._known[key]
        try:
            found = posture_of(files.get(derived_key(shape_id, PREVIEW, made_in)))
        except FileMissing:  # removed in this moment
            return None
        with self._lock:
            self._known[key] = found
            while len(self._known) > MOST:
                self._known.popitem(last=False)
        return found


def rehearse() -> None:
    """Load the compiled functions of this file; on a machine's first start they are compiled."""
    posture(np.eye(3), areas_of(np.eye(3), np.array([[0, 1, 2]])))


def posture_of(glb: bytes) -> SingleArray | None:
    """Return the posture of a preview; None where it cannot be read."""
    try:
        vertices, faces = read_points(glb)
    except NoPreview:
        return None
    return posture(vertices, areas_of(vertices, faces))
