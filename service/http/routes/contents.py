"""What belongs to a shape: its files, its pictures, its numbers."""

from pathlib import PurePosixPath
from typing import Annotated

from fastapi import APIRouter, Query
from starlette.responses import FileResponse, Response

from index.errors import FileMissing
from service.descriptors import shape_numbers
from service.http.dependencies import LibraryPart
from service.http.kept_files import file_response
from service.http.openapi import binary, problems
from service.http.reasons import FILE, NUMBERS, ONE_SHAPE, READING
from service.http.schemas import DescriptorsModel
from service.storage import PREVIEW, THUMBNAIL, derived_key
from worker.pictures.smaller import smaller

router = APIRouter(tags=["contents"])

WIDEST = 256  # pixels of a thumbnail as it is kept
Width = Annotated[int, Query(ge=32, le=WIDEST, description="of the picture, in pixels")]

OCTETS, GLB = "application/octet-stream", "model/gltf-binary"
PRIVATE = {"Cache-Control": "private, max-age=3600"}
SANDBOX = {"Content-Security-Policy": "default-src 'none'; sandbox", "Cache-Control": "private, no-cache"}


@router.get(
    "/shapes/{shape_id}/files/{name:path}",
    operation_id="downloadFile",
    summary="A file as it was uploaded",
    response_class=FileResponse,
    responses=binary(OCTETS, "the file") | problems(*READING, *ONE_SHAPE, *FILE),
)
def download(library: LibraryPart, shape_id: str, name: str) -> Response:
    """Return the bytes; browsers are told to save them, never to show them."""
    for file in library.catalogue.get(shape_id).files:
        if file.name == name:
            return file_response(library, file.key, OCTETS, SANDBOX, PurePosixPath(name).name)
    raise FileMissing(f"the upload held no file named {name!r}")


@router.get(
    "/shapes/{shape_id}/thumbnail.png",
    operation_id="getThumbnail",
    summary="A picture",
    response_class=FileResponse,
    responses=binary("image/png", "the picture") | problems(*READING, *ONE_SHAPE, *FILE),
)
def thumbnail(library: LibraryPart, shape_id: str, width: Width = WIDEST) -> Response:
    """Return a picture of a ready shape on a transparent background."""
    made_in = library.catalogue.get(shape_id).made_in
    return picture(library.files.get(derived_key(shape_id, THUMBNAIL, made_in)), width)


@router.get(
    "/shapes/{shape_id}/preview.glb",
    operation_id="getPreview",
    summary="A small mesh for viewers",
    response_class=FileResponse,
    responses=binary(GLB, "the mesh, with vertex colours") | problems(*READING, *ONE_SHAPE, *FILE),
)
def preview(library: LibraryPart, shape_id: str) -> Response:
    """Return a small coloured mesh of a ready shape."""
    made_in = library.catalogue.get(shape_id).made_in
    try:
        return file_response(library, derived_key(shape_id, PREVIEW, made_in), GLB, PRIVATE)
    except FileMissing:
        raise FileMissing(f"there is no {PREVIEW} before the shape is ready") from None


@router.get(
    "/shapes/{shape_id}/descriptors",
    operation_id="getDescriptors",
    summary="The numbers that are compared",
    responses=problems(*READING, *ONE_SHAPE, *NUMBERS),
)
def descriptors(library: LibraryPart, shape_id: str) -> DescriptorsModel:
    """Return the blocks of a ready shape under the active vocabulary, and its eigenvalues."""
    numbers = shape_numbers(library, shape_id)
    return DescriptorsModel(
        vocabulary=numbers.vocabulary_id,
        fingerprint=numbers.fingerprint,
        blocks={name: block.tolist() for name, block in numbers.blocks.items()},
        eigenvalues={weight: values.tolist() for weight, values in numbers.eigenvalues.items()},
    )


def picture(png: bytes, width: int) -> Response:
    """Return a thumbnail, made smaller where it is wider."""
    return Response(smaller(png, width), media_type="image/png", headers=PRIVATE)
