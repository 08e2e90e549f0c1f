"""Shells as OBJ with MTL and PNG: the paint is baked into a picture."""

import io
from collections.abc import Mapping

import numpy as np
from PIL import Image
from scipy.ndimage import distance_transform_edt

from service.samples.atlas import Atlas, unwrap
from service.samples.shell import Shell, vertex_normals
from service.samples.writing import bytes_of
from worker.arrays import ByteArray, FloatArray
from worker.pictures.rasterising import rasterise

SIDE = 512  # texels along the picture


def obj_files(shell: Shell, stem: str) -> Mapping[str, bytes]:
    """Return an OBJ, its MTL and its PNG."""
    atlas = unwrap(shell, SIDE)
    picture = io.BytesIO()
    Image.fromarray(bake(shell, atlas)).save(picture, "PNG")
    material = f"newmtl skin\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nmap_Kd {stem}.png\n"
    return {
        f"{stem}.obj": _obj(shell, atlas, stem),
        f"{stem}.mtl": material.encode(),
        f"{stem}.png": picture.getvalue(),
    }


def bake(shell: Shell, atlas: Atlas) -> ByteArray:
    """Paint the atlas: sRGB (side, side, 3); texels between patches take the nearest patch's colour."""
    seen = rasterise(atlas.texels, np.zeros(len(atlas.texels)), atlas.faces, atlas.side)
    corners = shell.faces[seen.faces]  # (k, 3)
    normals = vertex_normals(shell.rest, shell.faces)
    points = np.einsum("kc,kcd->kd", seen.barycentrics, shell.rest[corners])
    colours = bytes_of(shell.paint(points, np.einsum("kc,kcd->kd", seen.barycentrics, normals[corners])))
    empty = np.ones(atlas.side**2, dtype=bool)
    empty[seen.places] = False
    picture: FloatArray = np.zeros((atlas.side**2, 3))
    picture[seen.places] = colours
    rows, columns = distance_transform_edt(
        empty.reshape(atlas.side, atlas.side), return_distances=False, return_indices=True
    )
    filled: ByteArray = picture.reshape(atlas.side, atlas.side, 3)[rows, columns].astype(np.uint8)
    return filled


def _obj(shell: Shell, atlas: Atlas, stem: str) -> bytes:
    lines = [f"mtllib {stem}.mtl", f"o {stem}"]
    lines += [f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in shell.vertices.tolist()]
    uvs = atlas.texels / atlas.side
    lines += [f"vt {u:.5f} {1 - v:.5f}" for u, v in uvs.tolist()]
    lines.append("usemtl skin")
    pairs = np.stack([shell.faces, atlas.faces], axis=2).reshape(-1, 6) + 1
    lines += [f"f {a}/{p} {b}/{q} {c}/{r}" for a, p, b, q, c, r in pairs.tolist()]
    return "\n".join(lines).encode() + b"\n"
