"""From the bytes of an upload to its description: the one file that chains the rest."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray, SingleArray
from worker.canonical import Surface, canonical_surface
from worker.descriptors.curves import colour_curves, whiten_curves
from worker.descriptors.diffusion import distance_quantiles, joint_distances
from worker.descriptors.histograms import lab_histogram
from worker.descriptors.signatures import heat_kernel_signatures, log_differences
from worker.geometry.areas import edge_lengths, face_vectors, triangle_areas, vertex_areas
from worker.geometry.laplacian import cotangent_laplacian, joint_embedding, mesh_laplacian
from worker.geometry.repair import Repaired, repair
from worker.geometry.sampling import cell_areas, farthest_points
from worker.geometry.spectrum import Eigenpairs, solve_eigenpairs
from worker.parameters import Operator, Parameters
from worker.pictures.preview import preview
from worker.pictures.thumbnail import thumbnail
from worker.reading.limits import Limits
from worker.reading.mesh import Mesh
from worker.reading.upload import Upload, read_mesh


@dataclass(frozen=True, kw_only=True)
class MeshFacts:
    """What a user wants to know of the mesh that came."""

    vertices: int  # after welding
    faces: int  # after repair
    components: int  # connected pieces
    area: float  # in the file's own squared unit
    colour: str  # where the colour came from: texture, vertex, face, material or none
    warnings: tuple[str, ...]  # what was odd and how it was mended


@dataclass(frozen=True, kw_only=True, eq=False)
class Description:
    """All that is kept of a mesh but its files."""

    fingerprint: str  # of the parameters it was computed with
    facts: MeshFacts
    blocks: Mapping[str, SingleArray]  # vectors that need no vocabulary
    signatures: Mapping[str, SingleArray]  # what a vocabulary turns into the other blocks
    thumbnail: bytes  # PNG
    preview: bytes  # GLB


def describe(
    upload: Upload,
    parameters: Parameters = Parameters(),
    limits: Limits = Limits(),
) -> Description:
    """Read a mesh and compute everything that is compared.

    Parameters
    ----------
    upload : Upload
        Files as they were sent.
    parameters : Parameters
    limits : Limits

    Returns
    -------
    Description

    Raises
    ------
    MeshError
        Where the mesh is refused.
    """
    mesh = read_mesh(upload, limits)
    repaired = repair(mesh)
    surface = canonical_surface(mesh, repaired, parameters)
    blocks, signatures = describe_surface(surface, parameters)
    return Description(
        fingerprint=parameters.fingerprint(),
        facts=_facts(mesh, repaired),
        blocks=_single(blocks),
        signatures=_single(signatures),
        thumbnail=thumbnail(mesh, repaired),
        preview=preview(surface.vertices, surface.faces, surface.srgb),
    )


def describe_surface(
    surface: Surface, parameters: Parameters
) -> tuple[dict[str, FloatArray], dict[str, FloatArray]]:
    """Compute the blocks and signatures of a canonical surface.

    Returns
    -------
    blocks : dict
        ``colour-histogram`` (b,) and ``colour-curves`` (144,).
    signatures : dict
        ``areas`` (n,), ``hks-η`` (n, 6) and ``eigenvalues-η`` (k,) for each η, ``log-hks`` (n, 6),
        ``diffusion-geometric`` and ``diffusion-joint`` (quantiles), ``raw-curves`` (t, b, 3).
    """
    areas = _areas(surface)
    weights = sorted({*parameters.colour_weights, *parameters.distance_weights, 0.0})
    spectra = {weight: solve_joint(surface, weight, parameters) for weight in weights}
    geometric = spectra[0.0]
    orders = _signatures_at(geometric, parameters.curve_times)
    curves = colour_curves(orders, surface.lab, areas, parameters.curve_bins)
    blocks = {
        "colour-histogram": lab_histogram(
            surface.sample_lab, parameters.histogram_bins, parameters.histogram_smoothing
        ),
        "colour-curves": whiten_curves(curves),
    }
    signatures = {"areas": areas, "raw-curves": curves}
    signatures["log-hks"] = log_differences(_signatures_at(geometric, parameters.fine_times))
    for weight in parameters.colour_weights:
        signatures[f"hks-{weight:g}"] = _signatures_at(spectra[weight], parameters.times)
    for weight, spectrum in spectra.items():
        signatures[f"eigenvalues-{weight:g}"] = spectrum.eigenvalues
    return blocks, signatures | _distance_distributions(surface, areas, spectra, parameters)


def solve_joint(surface: Surface, weight: float, parameters: Parameters) -> Eigenpairs:
    """Solve the operator of geometry and colour joined with weight η."""
    points = joint_embedding(surface.vertices, surface.lab, weight)
    cutoff = parameters.cutoff if weight else parameters.fine_cutoff
    if parameters.operator is Operator.COTANGENT:
        stiffness, mass = cotangent_laplacian(points, surface.faces)
    else:
        mass = vertex_areas(
            surface.faces, triangle_areas(edge_lengths(points, surface.faces)), len(surface.vertices)
        )
        stiffness, mass = mesh_laplacian(points, mass, parameters.kernel_width, parameters.kernel_tail)
    return solve_eigenpairs(stiffness, mass, cutoff, parameters.eigenpairs)


def _distance_distributions(
    surface: Surface, areas: FloatArray, spectra: Mapping[float, Eigenpairs], parameters: Parameters
) -> dict[str, FloatArray]:
    samples = farthest_points(surface.vertices, parameters.distance_samples)
    cells = cell_areas(surface.vertices, samples, areas)
    sampled = [
        (spectra[weight].eigenvalues, spectra[weight].eigenfunctions[samples])
        for weight in (0.0, *parameters.distance_weights)
    ]
    systems = {"diffusion-geometric": sampled[:1], "diffusion-joint": sampled[1:]}
    return {
        name: distance_quantiles(
            joint_distances(system, parameters.distance_times), cells, parameters.distance_quantiles
        )
        for name, system in systems.items()
    }


def _signatures_at(spectrum: Eigenpairs, times: tuple[float, ...]) -> FloatArray:
    return heat_kernel_signatures(spectrum.eigenvalues, spectrum.eigenfunctions, np.array(times))


def _areas(surface: Surface) -> FloatArray:
    lengths = edge_lengths(surface.vertices, surface.faces)
    return vertex_areas(surface.faces, triangle_areas(lengths), len(surface.vertices))


def _facts(mesh: Mesh, repaired: Repaired) -> MeshFacts:
    area = np.linalg.norm(face_vectors(repaired.vertices, repaired.faces), axis=1).sum()
    return MeshFacts(
        vertices=len(repaired.vertices),
        faces=len(repaired.faces),
        components=repaired.components,
        area=float(area),
        colour=str(mesh.colour),
        warnings=mesh.warnings + repaired.warnings,
    )


def _single(arrays: Mapping[str, FloatArray]) -> dict[str, SingleArray]:
    return {name: np.ascontiguousarray(array, dtype=np.float32) for name, array in arrays.items()}
