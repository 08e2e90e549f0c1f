"""From the bytes of an upload to its description: the one file that chains the rest."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray, SingleArray
from worker.canonical import Surface, canonical_surface
from worker.descriptors.curves import colour_curves, whiten_curves
from worker.descriptors.histograms import join_bins, lab_histogram
from worker.descriptors.landmarks import pack, place_landmarks
from worker.descriptors.meshhog import mesh_features
from worker.geometry.repair import Repaired, repair
from worker.geometry.resampling import face_areas
from worker.geometry.spectrum import Eigenpairs
from worker.intrinsic import Intrinsic, describe_triangles, distribution, signatures_at
from worker.parameters import Parameters
from worker.pictures.preview import preview
from worker.pictures.thumbnail import thumbnail
from worker.reading.limits import Limits
from worker.reading.mesh import Mesh
from worker.reading.upload import Upload, read_mesh
from worker.solving import solve_joint
from worker.stages import DESCRIPTORS, PICTURES, READ, REPAIR, SPECTRUM, stage


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
    with stage(READ):
        mesh = read_mesh(upload, limits)
    with stage(REPAIR):
        repaired = repair(mesh)
        surface = canonical_surface(mesh, repaired, parameters)
    blocks, signatures = describe_surface(surface, parameters)
    with stage(PICTURES):
        small = thumbnail(mesh, repaired)
        whole = preview(surface.vertices, surface.faces, surface.srgb)
    return Description(
        fingerprint=parameters.fingerprint(),
        facts=_facts(mesh, repaired),
        blocks=in_single_precision(blocks),
        signatures=in_single_precision(signatures),
        thumbnail=small,
        preview=whole,
    )


def describe_surface(
    surface: Surface, parameters: Parameters, intrinsic: Intrinsic | None = None
) -> tuple[dict[str, FloatArray], dict[str, FloatArray]]:
    """Compute the blocks and signatures of a canonical surface.

    Parameters
    ----------
    surface : Surface
    parameters : Parameters
    intrinsic : Intrinsic, optional
        As from `describe_triangles` for the same triangles, where several colourings share them.

    Returns
    -------
    blocks : dict
        ``colour-histogram`` (c,), ``colour-curves`` (144,), ``landmarks`` (10 p,).
    signatures : dict
        ``areas`` (n,), ``hks-η`` (n, 6) and ``eigenvalues-η`` (k,) for each η, ``log-hks`` (n, 6),
        ``diffusion-geometric`` and ``diffusion-joint`` (quantiles), ``landmark-ladder`` (p, j),
        ``meshhog`` (f, 96), of L.
    """
    shared = intrinsic or describe_triangles(surface.vertices, surface.faces, parameters)
    with stage(SPECTRUM):
        spectra = _spectra(surface, shared, parameters)
    with stage(DESCRIPTORS):
        return _blocks(surface, shared, parameters), _signatures(surface, shared, spectra, parameters)


def _spectra(surface: Surface, shared: Intrinsic, parameters: Parameters) -> dict[float, Eigenpairs]:
    """Return the eigenpairs at each weight of colour."""
    return {
        weight: solve_joint(surface.vertices, surface.faces, surface.lab, weight, parameters)
        for weight in {*parameters.colour_weights, *parameters.distance_weights} - {0.0}
    } | {0.0: shared.spectrum}


def _blocks(surface: Surface, shared: Intrinsic, parameters: Parameters) -> dict[str, FloatArray]:
    placed = place_landmarks(
        surface.vertices, shared.landmarks, shared.areas, surface.lab, parameters.landmarks
    )
    return {
        "landmarks": pack(shared.signatures["landmark-ladder"], placed).ravel(),
        "colour-histogram": join_bins(
            lab_histogram(surface.sample_lab, parameters.histogram_bins, parameters.histogram_smoothing),
            parameters.histogram_bins,
            parameters.histogram_lightness,
            parameters.histogram_chroma,
        ),
        "colour-curves": whiten_curves(
            colour_curves(shared.orders, surface.lab, shared.areas, parameters.curve_bins)
        ),
    }


def _signatures(
    surface: Surface, shared: Intrinsic, spectra: Mapping[float, Eigenpairs], parameters: Parameters
) -> dict[str, FloatArray]:
    signatures = dict(shared.signatures)
    for weight, spectrum in sorted(spectra.items()):
        signatures[f"eigenvalues-{weight:g}"] = spectrum.eigenvalues
        if weight in parameters.colour_weights:
            signatures[f"hks-{weight:g}"] = signatures_at(spectrum, parameters.times)
    signatures["meshhog"] = mesh_features(surface.lab[:, 0], surface.vertices, surface.faces)
    signatures["diffusion-joint"] = distribution(
        [spectra[weight] for weight in parameters.distance_weights], shared.samples, shared.shares, parameters
    )
    return signatures


def _facts(mesh: Mesh, repaired: Repaired) -> MeshFacts:
    area = face_areas(repaired.vertices, repaired.faces).sum()
    return MeshFacts(
        vertices=len(repaired.vertices),
        faces=len(repaired.faces),
        components=repaired.components,
        area=float(area),
        colour=str(mesh.colour),
        warnings=mesh.warnings + repaired.warnings,
    )


def in_single_precision(arrays: Mapping[str, FloatArray | SingleArray]) -> dict[str, SingleArray]:
    """Return arrays as they are kept."""
    return {name: np.ascontiguousarray(array, dtype=np.float32) for name, array in arrays.items()}
