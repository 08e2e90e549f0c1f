"""Seeds that need no folder of meshes: every format, and every kind of image, written in code."""

import io
import zipfile
from collections.abc import Iterator, Mapping

import numpy as np
from PIL import Image

from tests.fakes import coloured_triangle
from tests.mesh_files import TEXTURED, ply_ascii, ply_binary, png
from tests.shapes import box, sphere

# Endings by the name that Pillow gives the format; a texture of each kind is a seed.
_IMAGES = {
    "PNG": "png",
    "JPEG": "jpg",
    "BMP": "bmp",
    "TGA": "tga",
    "TIFF": "tif",
    "WEBP": "webp",
    "GIF": "gif",
    "JPEG2000": "jp2",
    "PPM": "ppm",
    "DDS": "dds",
    "PCX": "pcx",
}

_RICH_PLY = """ply
format ascii 1.0
comment TextureFile a.png
comment TextureFile b.png
element vertex 5
property double x
property double y
property double z
property float nx
property ushort red
property ushort green
property ushort blue
property uchar alpha
property float s
property float t
element face 4
property list uchar uint vertex_index
property list uchar float texcoord
property int texnumber
property uchar red
property uchar green
property uchar blue
element edge 1
property int vertex1
property int vertex2
end_header
0 0 0 1 65535 0 0 255 0 0
1 0 0 1 0 65535 0 255 1 0
1 1 0.5 1 0 0 65535 255 1 1
0 1 0 1 9 9 9 255 0 1
.5 .5 -1e0 1 7 7 7 0 0.5 0.5
4 0 1 2 3 8 0 0 1 0 1 1 0 1 0 255 0 0
3 0 1 4 6 0 0 1 0 .5 .5 1 0 255 0
3 1 2 4 0 0 0 0 255
5 0 1 2 3 4 0 -1 1 2 3
0 1
"""

_RICH_OBJ = """# groups, quads, a concave polygon, relative indices, a line that goes on
mtllib m.mtl
o thing
v 0 0 0 1 0 0
v 2 0 0 0 1 0
v 2 2 0.5 0 0 1
v 1 .5 0 1 1 0
v 0 2 0 0 1 1
v -1.5e-1 1 -2 .5 .5 .5
vt 0 0
vt 1 0 0
vt 1 1
vt .5 .25
vt 0 1
vn 0 0 1
g first
usemtl a
f 1/1/1 2/2/1 3/3/1 4/4/1 5/5/1
usemtl b
f -6 -5 \\
 -1
s off
f 1//1 2//1 6//1
usemtl a
f 3/3 5/5 -1/-1
l 1 2 3
"""

_RICH_MTL = """newmtl a
Kd 0.8 0.2 0.1
map_Kd -s 2 2 -o 0.5 0 1 -clamp on a.png
newmtl b
Kd 0.1
Ns 10
newmtl c
map_Kd "folder\\\\b.png"
"""


def written_seeds() -> Iterator[tuple[str, Mapping[str, bytes]]]:
    """Yield names and uploads."""
    yield from _ply_files()
    yield from _obj_files()
    yield from _archives()


def _ply_files() -> Iterator[tuple[str, Mapping[str, bytes]]]:
    vertices, triangles = sphere(1)
    faces = [*triangles.tolist(), [0, 1, 2, 3], [4, 5, 6, 7, 8]]
    yield "written/ascii", {"a.ply": ply_ascii(vertices, faces)}
    yield "written/little", {"a.ply": ply_binary(vertices, faces[:80])}
    yield "written/little-mixed", {"a.ply": ply_binary(vertices, faces)}
    yield "written/big-mixed", {"a.ply": ply_binary(vertices, faces, ">")}
    yield "written/coloured", {"a.ply": coloured_triangle()}
    rich = {"folder/a.ply": _RICH_PLY.encode(), "folder/a.png": png(), "folder/b.png": _picture("PNG", "P")}
    yield "written/rich-ply", rich
    yield "written/rich-ply-crlf", rich | {"folder/a.ply": _RICH_PLY.replace("\n", "\r\n").encode()}
    yield "written/textured-ply", {"a.ply": _textured_ply(), "a.png": png()}


def _textured_ply() -> bytes:
    """Write a binary box whose faces list texture coordinates."""
    vertices, faces, uvs = box()
    header = (
        "ply\nformat binary_big_endian 1.0\ncomment TextureFile a.png\nelement vertex 8\nproperty double x\n"
        "property double y\nproperty double z\nelement face 12\nproperty list uint short vertex_indices\n"
        "property list uchar float texcoord\nproperty short texnumber\nend_header\n"
    )
    rows = np.zeros(12, dtype=[("n", ">u4"), ("c", ">i2", 3), ("k", "u1"), ("uv", ">f4", 6), ("t", ">i2")])
    rows["n"], rows["c"], rows["k"], rows["uv"] = 3, faces, 6, uvs.reshape(12, 6)
    return header.encode() + vertices.astype(">f8").tobytes() + rows.tobytes()


def _obj_files() -> Iterator[tuple[str, Mapping[str, bytes]]]:
    rich = {"m.obj": _RICH_OBJ.encode(), "m.mtl": _RICH_MTL.encode(), "a.png": png()}
    yield "written/rich-obj", rich
    yield "written/rich-obj-cr", rich | {"m.obj": _RICH_OBJ.replace("\n", "\r").encode()}
    yield "written/plain-obj", {"m.obj": b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n"}
    for format_, ending in _IMAGES.items():
        yield f"written/image-{ending}", _with_image(f"a.{ending}", _picture(format_))
    for mode in ("1", "L", "LA", "P", "RGBA", "I;16"):
        yield f"written/png-{mode}", _with_image("a.png", _picture("PNG", mode))
    for mode in ("CMYK", "F", "I;16", "I", "LAB", "P", "YCbCr"):
        yield f"written/tiff-{mode}", _with_image("a.tif", _picture("TIFF", mode))
    yield "written/tiff-deflate", _with_image("a.tif", _picture("TIFF", compression="tiff_adobe_deflate"))
    yield "written/gif-moving", _with_image("a.gif", _moving("GIF"))
    yield "written/png-moving", _with_image("a.png", _moving("PNG"))


def _with_image(name: str, image: bytes) -> Mapping[str, bytes]:
    return {"m.obj": TEXTURED.encode(), "m.mtl": f"newmtl a\nmap_Kd {name}\n".encode(), name: image}


def _picture(format_: str, mode: str = "RGB", **options: str) -> bytes:
    stream = io.BytesIO()
    pixels = np.arange(192, dtype=np.uint8).reshape(8, 8, 3)
    picture = Image.fromarray(pixels).convert("L").convert(mode) if ";" in mode else _converted(pixels, mode)
    picture.save(stream, format_, **options)
    return stream.getvalue()


def _converted(pixels: np.ndarray, mode: str) -> Image.Image:
    picture = Image.fromarray(pixels)
    return Image.merge("LAB", picture.split()) if mode == "LAB" else picture.convert(mode)


def _moving(format_: str) -> bytes:
    stream = io.BytesIO()
    frames = [Image.new("RGB", (8, 8), (level, 0, 99)) for level in (0, 100, 200)]
    frames[0].save(stream, format_, save_all=True, append_images=frames[1:])
    return stream.getvalue()


def _archives() -> Iterator[tuple[str, Mapping[str, bytes]]]:
    textured = {"m.obj": TEXTURED.encode(), "m.mtl": b"newmtl a\nmap_Kd a.png\n", "a.png": png()}
    for kind, method in (("stored", zipfile.ZIP_STORED), ("deflated", zipfile.ZIP_DEFLATED)):
        yield f"written/zip-{kind}", {"a.zip": archive(textured, method)}
    odd = {"übung/形.ply": coloured_triangle(), "__MACOSX/._a.ply": b"\0", "übung/": b""}
    yield "written/zip-unicode", {"a.zip": archive(odd, zipfile.ZIP_DEFLATED)}


def archive(files: Mapping[str, bytes], method: int = zipfile.ZIP_STORED) -> bytes:
    """Return a zip of files, the same bytes every time."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", method) as zipped:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name)
            entry.compress_type = method
            zipped.writestr(entry, data)
    return stream.getvalue()
