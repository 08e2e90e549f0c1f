"""Which files a shape needs."""

from index.dumping import Belongings
from index.files import FileStore
from index.shapes import StoredFile
from service.storage import MADE, derived_key


def needed_files(shape: Belongings) -> dict[str, StoredFile | None]:
    """Return the keys without which a shape is not whole, with what the catalogue knows of the content."""
    made = [derived_key(shape.id, name, shape.made_in) for name in MADE] if shape.ready else []
    return {**{file.key: file for file in shape.files}, **dict.fromkeys(made)}


def present_files(files: FileStore, shape: Belongings) -> dict[str, StoredFile | None]:
    """Return those keys, and those of everything else that is kept for the shape."""
    others = dict.fromkeys(files.keys(f"shapes/{shape.id}"))
    return others | needed_files(shape)


def made_prefix(shape_id: str) -> str:
    """Return how the keys of what was made for a shape begin."""
    return derived_key(shape_id, "")
