"""Headers alone refuse what they can, and nothing that a full reading accepts."""

from collections.abc import Mapping

import numpy as np
import pytest

from tests.mesh_files import TEXTURED, TRIANGLE, ply_binary, ply_header, png
from worker.errors import Code, MeshError
from worker.reading.inspection import inspect_files
from worker.reading.limits import Limits
from worker.reading.references import SentFiles

MTL = b"newmtl a\nmap_Kd t.png\n"


def inspect(files: Mapping[str, bytes | str], *, allow_untextured: bool = False) -> None:
    contents = {name: data.encode() if isinstance(data, str) else data for name, data in files.items()}
    inspect_files(
        SentFiles(contents), next(iter(contents)), Limits(image_pixels=100), allow_untextured=allow_untextured
    )


def refused(files: Mapping[str, bytes | str]) -> Code:
    with pytest.raises(MeshError) as caught:
        inspect(files)
    return caught.value.code


def test_a_whole_textured_mesh_passes() -> None:
    inspect({"m.obj": TEXTURED, "m.mtl": MTL, "t.png": png()})
    inspect({"m.ply": ply_binary(np.eye(3), [[0, 1, 2]])})


@pytest.mark.parametrize(
    ("files", "code"),
    [
        ({"m.ply": ply_header("binary_little_endian", 9, 9)}, Code.TRUNCATED),
        ({"m.ply": b"v 0 0 0"}, Code.NOT_PLY),
        ({"m.obj": b""}, Code.EMPTY),
        ({"m.obj": TEXTURED}, Code.MISSING_TEXTURE),
        ({"m.obj": TEXTURED, "m.mtl": MTL}, Code.MISSING_TEXTURE),
        ({"m.obj": TEXTURED, "m.mtl": b"newmtl a\nmap_Kd /etc/x\n"}, Code.UNSAFE_REFERENCE),
        ({"m.obj": TEXTURED, "m.mtl": MTL, "t.png": b"<html>"}, Code.BAD_IMAGE),
        (
            {"m.obj": TEXTURED, "m.mtl": MTL, "t.png": png(np.zeros((20, 20, 3), np.uint8))},
            Code.IMAGE_TOO_LARGE,
        ),
    ],
)
def test_what_headers_tell_is_refused(files: dict[str, bytes | str], code: Code) -> None:
    assert refused(files) == code


def test_the_texture_of_a_ply_is_looked_for() -> None:
    extra = "property float s\nproperty float t\n"
    header = ply_header("ascii", 3, 1, extra).replace(
        b"element vertex", b"comment TextureFile t.png\nelement vertex"
    )
    data = header + b"0 0 0 0 0\n" * 3 + b"3 0 1 2\n"
    assert refused({"m.ply": data}) == Code.MISSING_TEXTURE
    inspect({"m.ply": data, "t.png": png()})
    inspect({"m.ply": data}, allow_untextured=True)


def test_an_image_that_no_face_shows_may_be_missing() -> None:
    plain = TEXTURED.replace("f 1/1 2/2 3/3", "f 1 2 3")
    inspect({"m.obj": plain, "m.mtl": MTL})
    inspect({"m.obj": f"mtllib gone.mtl\n{TRIANGLE}f 1 2 3\n"})
