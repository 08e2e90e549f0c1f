"""A mesh in canonical form: even triangles, area averages of colour, one size."""

from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.geometry.areas import face_vectors, norms, unit, vertex_normals
from worker.geometry.cells import Cells, cell_means, cells_of
from worker.geometry.colour import look_up_colours, srgb_to_lab
from worker.geometry.repair import Repaired
from worker.geometry.resampling import edge_of, normalise_area, retriangulate, sample_surface
from worker.geometry.texels import interpolate
from worker.parameters import Parameters
from worker.reading.mesh import Mesh


@dataclass(frozen=True, kw_only=True, eq=False)
class Canvas:
    """A canonical surface before its colours; meshes that differ in colour alone share it."""

    vertices: FloatArray  # (n, 3)
    faces: IntArray  # (m, 3)
    sample_faces: IntArray  # (k,), the face of the mesh as read that each colour sample lies in
    sample_places: FloatArray  # (k, 3), barycentric coordinates there
    footprints: FloatArray  # (k,), the share of its face that each sample stands for
    cells: Cells  # of the samples, among the vertices


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
    return paint(mesh, stretch_canvas(repaired, parameters))


def stretch_canvas(repaired: Repaired, parameters: Parameters) -> Canvas:
    """Resample a repaired mesh, and choose where its colours are looked up."""
    area, n_vertices = parameters.surface_area, parameters.vertices
    edge = edge_of(area, n_vertices)
    source = normalise_area(repaired.vertices, repaired.faces, area)
    vertices, faces = retriangulate(source, repaired.faces, n_vertices, edge)
    indices, barycentrics = sample_surface(source, repaired.faces, parameters.colour_samples)
    sampled = face_vectors(source, repaired.faces[indices])  # (k, 3)
    footprints = area / parameters.colour_samples / norms(sampled)
    sample_faces, sample_places = _in_source(repaired, indices, barycentrics)
    return Canvas(
        vertices=normalise_area(vertices, faces, area),  # not before samples have found their cells
        faces=faces,
        sample_faces=sample_faces,
        sample_places=sample_places,
        footprints=np.minimum(footprints, 1.0),
        cells=cells_of(
            interpolate(source[repaired.faces], indices, barycentrics),
            unit(sampled),
            vertices,
            vertex_normals(vertices, faces),
            edge,
        ),
    )


def paint(mesh: Mesh, canvas: Canvas) -> Surface:
    """Look up the colours of a mesh on the canvas that was made from its triangles."""
    faces, places = canvas.sample_faces, canvas.sample_places
    srgb = look_up_colours(mesh, faces, places, canvas.footprints)
    lab = srgb_to_lab(srgb)
    means = cell_means(np.hstack([srgb, lab]), canvas.cells)
    return Surface(
        vertices=canvas.vertices,
        faces=canvas.faces,
        srgb=means[:, :3],
        lab=means[:, 3:],
        sample_lab=srgb_to_lab(look_up_colours(mesh, faces, places)) if mesh.textures else lab,
    )


def _in_source(
    repaired: Repaired, indices: IntArray, barycentrics: FloatArray
) -> tuple[IntArray, FloatArray]:
    """Name points of the repaired surface by the faces and corners of the mesh as read."""
    places = np.empty_like(barycentrics)
    np.put_along_axis(places, repaired.source_corners[indices], barycentrics, axis=1)
    return repaired.source_faces[indices], places
