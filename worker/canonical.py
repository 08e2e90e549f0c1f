"""A mesh in canonical form: even triangles, area averages of colour, one size."""

from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.geometry.areas import face_vectors, unit, vertex_normals
from worker.geometry.colour import average_over_cells, look_up_colours, srgb_to_lab
from worker.geometry.repair import Repaired
from worker.geometry.resampling import edge_of, normalise_area, resample, sample_surface
from worker.parameters import Parameters
from worker.reading.mesh import Mesh


@dataclass(frozen=True, kw_only=True, eq=False)
class Surface:
    """What every descriptor is computed from; lengths in units of the canonical area."""

    vertices: FloatArray  # (n, 3)
    faces: IntArray  # (m, 3)
    srgb: FloatArray  # (n, 3), area average of the colour over each vertex's cell, 0…1
    lab: FloatArray  # (n, 3), the same average in CIE Lab
    sample_lab: FloatArray  # (k, 3), the source's own colours at equal-area samples, not averaged


def canonical_surface(mesh: Mesh, repaired: Repaired, parameters: Parameters) -> Surface:
    """Bring a repaired mesh to the canonical area, resolution and colour.

    Parameters
    ----------
    mesh : Mesh
        The mesh as read, for its colours.
    repaired : Repaired
        Its repaired triangles.
    parameters : Parameters

    Returns
    -------
    Surface
    """
    area, n_vertices = parameters.surface_area, parameters.vertices
    vertices, faces = resample(repaired.vertices, repaired.faces, area, n_vertices)
    source = normalise_area(repaired.vertices, repaired.faces, area)
    indices, barycentrics = sample_surface(source, repaired.faces, parameters.colour_samples)
    vectors = face_vectors(source, repaired.faces)
    footprints = area / parameters.colour_samples / np.linalg.norm(vectors, axis=1)[indices]
    faces_read, places_read = _in_source(repaired, indices, barycentrics)
    srgb = look_up_colours(mesh, faces_read, places_read, np.minimum(footprints, 1.0))
    lab = srgb_to_lab(srgb)
    points = np.einsum("kc,kcd->kd", barycentrics, source[repaired.faces[indices]])
    means = average_over_cells(
        points,
        unit(vectors)[indices],
        np.hstack([srgb, lab]),
        vertices,
        vertex_normals(vertices, faces),
        edge_of(area, n_vertices),
    )
    texels = srgb_to_lab(look_up_colours(mesh, faces_read, places_read)) if mesh.textures else lab
    return Surface(vertices=vertices, faces=faces, srgb=means[:, :3], lab=means[:, 3:], sample_lab=texels)


def _in_source(
    repaired: Repaired, indices: IntArray, barycentrics: FloatArray
) -> tuple[IntArray, FloatArray]:
    """Name points of the repaired surface by the faces and corners of the mesh as read."""
    places = np.empty_like(barycentrics)
    np.put_along_axis(places, repaired.source_corners[indices], barycentrics, axis=1)
    return repaired.source_faces[indices], places
