"""Every number that changes a descriptor, in one frozen place."""

import hashlib
import json
from dataclasses import asdict, dataclass
from enum import StrEnum

FORMAT = 3  # raised whenever the code changes a descriptor without changing a number below


class Operator(StrEnum):
    """The two discretisations of the Laplacian."""

    COTANGENT = "cotangent"
    MESH_LAPLACE = "mesh-laplace"


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Numbers of the paper (Kovnatsky et al. 2011) and of this project.

    Lengths are in units of a surface scaled to ``surface_area`` (centimetres on a human body),
    times in squared units, colours in CIE Lab (D65).
    """

    surface_area: float = 19_000.0  # square units; 1.9 m², a human body
    vertices: int = 5_000  # canonical resolution
    colour_samples: int = 60_000  # points at which the surface's colour is looked up, at least
    operator: Operator = Operator.COTANGENT
    kernel_width: float = 2.0  # ρ of mesh-laplace, squared units
    kernel_tail: float = 1e-6  # relative weight at which the mesh-laplace kernel is cut
    times: tuple[float, ...] = (1024.0, 1351.2, 1782.9, 2352.5, 3104.2, 4096.0)  # of cHKS
    colour_weights: tuple[float, ...] = (0.0, 0.05, 0.1)  # η of cHKS
    cutoff: float = 0.017  # eigenvalues below this are computed, for times of 1024 and more
    fine_times: tuple[float, ...] = (
        64.0,
        128.0,
        256.0,
        512.0,
        1024.0,
        2048.0,
        4096.0,
    )  # of the log-HKS words
    fine_cutoff: float = 0.042  # the same for the log-HKS words, η = 0: about 64 pairs
    eigenpairs: int = 200  # cap on those of one connected piece
    distance_times: tuple[float, ...] = (1024.0, 4096.0)  # T of the diffusion distances
    distance_weights: tuple[float, ...] = (0.0, 0.1, 0.2)  # H of the joint diffusion distance
    distance_samples: int = 2_500  # farthest points
    distance_quantiles: int = 1_024  # levels at which a distance distribution is kept
    histogram_bins: int = 16  # of the Lab histogram, along each axis
    histogram_smoothing: float = 0.7  # σ in bins
    histogram_lightness: tuple[int, ...] = (2,) * 8  # bins that are joined along L
    histogram_chroma: tuple[int, ...] = (4, 2, 1, 1, 1, 1, 2, 4)  # along a and b; finest around grey
    curve_times: tuple[float, ...] = (256.0, 1024.0, 4096.0)  # orders of the colour curves
    curve_bins: int = 16  # equal areas along each order
    landmarks: int = 256  # points by which shapes are registered

    def fingerprint(self) -> str:
        """Return 16 hexadecimal digits that change with any number here."""
        text = json.dumps({"format": FORMAT, **asdict(self)}, sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:16]
