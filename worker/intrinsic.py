"""What the triangles of a surface decide, whatever its colours."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.descriptors.diffusion import distance_quantiles
from worker.descriptors.landmarks import LADDER, log_heat_ladder
from worker.descriptors.signatures import heat_kernel_signatures, log_differences, log_of
from worker.geometry.sampling import cell_areas, farthest_points
from worker.geometry.spectrum import Eigenpairs
from worker.parameters import Parameters
from worker.solving import areas_of, solve_joint
from worker.stages import DESCRIPTORS, SPECTRUM, stage


@dataclass(frozen=True, kw_only=True, eq=False)
class Intrinsic:
    """Spectrum, points and signatures at η = 0."""

    areas: FloatArray  # (n,), of the vertices
    spectrum: Eigenpairs  # at η = 0
    orders: FloatArray  # (n, t), heat kernel signatures by which colour curves are ordered
    samples: IntArray  # (s,), vertices between which distances are taken
    shares: FloatArray  # (s,), area that each of them stands for
    landmarks: IntArray  # (p,), the first of them: points by which shapes are registered
    signatures: Mapping[str, FloatArray]  # those that colours do not change


def describe_triangles(vertices: FloatArray, faces: IntArray, parameters: Parameters) -> Intrinsic:
    """Compute what all colourings of the same canonical triangles share.

    Parameters
    ----------
    vertices : (n, 3) array
    faces : (m, 3) array
    parameters : Parameters

    Returns
    -------
    Intrinsic
    """
    areas = areas_of(vertices, faces)
    with stage(SPECTRUM):
        spectrum = solve_joint(vertices, faces, np.zeros_like(vertices), 0.0, parameters)
    with stage(DESCRIPTORS):
        return _intrinsic(vertices, areas, spectrum, parameters)


def _intrinsic(
    vertices: FloatArray, areas: FloatArray, spectrum: Eigenpairs, parameters: Parameters
) -> Intrinsic:
    samples = farthest_points(vertices, parameters.distance_samples)
    shares = cell_areas(vertices, samples, areas)
    landmarks = samples[: parameters.landmarks]  # the farthest points of fewer are the first of many
    at_landmarks = heat_kernel_signatures(
        spectrum.eigenvalues, spectrum.eigenfunctions[landmarks], np.array(LADDER)
    )
    return Intrinsic(
        areas=areas,
        spectrum=spectrum,
        orders=signatures_at(spectrum, parameters.curve_times),
        samples=samples,
        shares=shares,
        landmarks=landmarks,
        signatures={
            "areas": areas,
            "log-hks": log_differences(signatures_at(spectrum, parameters.fine_times)),
            "landmark-ladder": log_heat_ladder(log_of(at_landmarks), parameters.landmarks),
            "diffusion-geometric": distribution([spectrum], samples, shares, parameters),
        },
    )


def signatures_at(spectrum: Eigenpairs, times: tuple[float, ...]) -> FloatArray:
    """Return heat kernel signatures (n, t) at some times."""
    return heat_kernel_signatures(spectrum.eigenvalues, spectrum.eigenfunctions, np.array(times))


def distribution(
    spectra: Sequence[Eigenpairs], samples: IntArray, shares: FloatArray, parameters: Parameters
) -> FloatArray:
    """Return the quantiles of the diffusion distances, joint over the spectra, between sampled vertices."""
    sampled = [(spectrum.eigenvalues, spectrum.eigenfunctions[samples]) for spectrum in spectra]
    return distance_quantiles(sampled, parameters.distance_times, shares, parameters.distance_quantiles)
