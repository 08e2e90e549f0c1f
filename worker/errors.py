"""Why a mesh is refused: one exception, one stable code for each reason."""

from enum import StrEnum


class Code(StrEnum):
    """Stable names of the reasons; clients may rely on them."""

    EMPTY = "empty"  # the file holds no bytes
    NO_MESH = "no_mesh"  # the upload or archive holds no .ply or .obj
    SEVERAL_MESHES = "several_meshes"  # it holds more than one
    NOT_PLY = "not_ply"  # named .ply, but is something else
    NOT_OBJ = "not_obj"  # named .obj, but is something else
    NOT_UTF8 = "not_utf8"  # text in another encoding
    UNSUPPORTED = "unsupported"  # valid, but a form that is not read (triangle strips)
    BAD_HEADER = "bad_header"  # the PLY header contradicts itself or lacks something
    BAD_DATA = "bad_data"  # the body contradicts the header or itself
    BAD_NUMBER = "bad_number"  # a word where a number should stand
    TRUNCATED = "truncated"  # the file ends before its own header says
    TRAILING_DATA = "trailing_data"  # the file goes on after its own header's end
    INDEX_OUT_OF_RANGE = "index_out_of_range"  # a face names a vertex that is not there
    NON_FINITE = "non_finite"  # NaN or infinity
    NO_FACES = "no_faces"  # points or lines only
    ZERO_AREA = "zero_area"  # nothing is left when degenerate faces are dropped
    MISSING_TEXTURE = "missing_texture"  # a named MTL or image was not sent
    UNSAFE_REFERENCE = "unsafe_reference"  # a file name points outside the upload
    BAD_IMAGE = "bad_image"  # a texture that no image reader understands
    IMAGE_TOO_LARGE = "image_too_large"  # over the limit of pixels
    BAD_ARCHIVE = "bad_archive"  # damaged, encrypted, nested, or with links
    ARCHIVE_TOO_LARGE = "archive_too_large"  # unpacks to more than the limits
    TOO_COMPLEX = "too_complex"  # too many faces, or over time or memory
    UNSOLVED = "unsolved"  # the spectrum could not be certified


class MeshError(Exception):
    """A mesh is refused.

    Parameters
    ----------
    code : Code
        The stable reason.
    detail : str
        What was expected and what came, in words for the person who sent the file.
    """

    def __init__(self, code: Code, detail: str) -> None:
        super().__init__(code, detail)
        self.code = code
        self.detail = detail

    def __str__(self) -> str:
        return f"{self.code}: {self.detail}"
