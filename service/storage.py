"""Under which keys a library keeps its files, and the signatures among them."""

import io
from collections.abc import Mapping
from zipfile import ZipFile

import numpy as np

from index.files import FileStore
from worker.arrays import SingleArray

THUMBNAIL = "thumbnail.png"
PREVIEW = "preview.glb"
SIGNATURES = "signatures.npz"
MADE = (THUMBNAIL, PREVIEW, SIGNATURES)  # of every shape that is ready


def upload_key(upload_id: str, number: int) -> str:
    """Return the key of an uploaded file; its own name stays in the catalogue."""
    return f"uploads/{upload_id}/{number}"


def derived_key(shape_id: str, name: str, made_in: str | None = None) -> str:
    """Return the key of something that was computed for a shape.

    Parameters
    ----------
    made_in : str, optional
        The folder of what was made of a shape that was described anew; see `index.shapes.Shape`.
    """
    return f"shapes/{shape_id}/{name}" if made_in is None else f"shapes/{shape_id}/{made_in}/{name}"


def save_signatures(
    files: FileStore, shape_id: str, signatures: Mapping[str, SingleArray], made_in: str | None = None
) -> None:
    """Keep the signatures of a shape, in single precision, for every vocabulary to come."""
    files.put(derived_key(shape_id, SIGNATURES, made_in), saved_arrays(signatures))


def saved_arrays(arrays: Mapping[str, SingleArray]) -> bytes:
    """Return arrays by name as the bytes of an ``.npz``, in single precision."""
    buffer = io.BytesIO()
    single = {name: np.asarray(values, dtype=np.float32) for name, values in arrays.items()}
    np.savez(buffer, allow_pickle=False, **single)
    return buffer.getvalue()


def load_signatures(files: FileStore, shape_id: str, made_in: str | None = None) -> dict[str, SingleArray]:
    """Return the signatures of a ready shape; FileMissing where there are none."""
    data = files.get(derived_key(shape_id, SIGNATURES, made_in))
    with np.load(io.BytesIO(data), allow_pickle=False) as archive:
        return {name: archive[name] for name in archive.files}


def load_signature(files: FileStore, shape_id: str, name: str, made_in: str | None = None) -> SingleArray:
    """Return one signature of a ready shape, without reading the others; FileMissing where there are none."""
    key = derived_key(shape_id, SIGNATURES, made_in)
    with files.open(key) as file, ZipFile(file) as archive, archive.open(f"{name}.npy") as member:
        found: SingleArray = np.lib.format.read_array(member, allow_pickle=False)
    return found
