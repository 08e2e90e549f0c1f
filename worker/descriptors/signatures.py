"""Heat kernel signatures: how much heat stays at each point of a surface."""

import numpy as np

from worker.arrays import FloatArray


def heat_kernel_signatures(
    eigenvalues: FloatArray, eigenfunctions: FloatArray, times: FloatArray
) -> FloatArray:
    """Return h_t(x, x) = Σ_i e^{−λ_i t} φ_i(x)².

    Sun, Ovsjanikov and Guibas (2009), equation 2. On the joint operator of geometry and colour this is the
    colour heat kernel signature of Kovnatsky et al. (2011), section 4.

    Parameters
    ----------
    eigenvalues : (k,) array
        λ, in 1 / squared units.
    eigenfunctions : (n, k) array
        φ, orthonormal in the area inner product.
    times : (t,) array
        Squared units.

    Returns
    -------
    (n, t) array
        1 / squared units; its area integral is Σ_i e^{−λ_i t}.
    """
    decay = np.exp(-np.outer(eigenvalues, times))  # (k, t)
    return np.asarray(eigenfunctions**2 @ decay)


def log_differences(signatures: FloatArray) -> FloatArray:
    """Return log h at each time less log h at the time before: the local rate of cooling.

    After Bronstein and Kokkinos (2010), equation 9: a factor on the whole signature cancels.

    Parameters
    ----------
    signatures : (n, t) array
        Positive.

    Returns
    -------
    (n, t − 1) array
    """
    return np.diff(log_of(signatures), axis=1)


def log_of(signatures: FloatArray) -> FloatArray:
    """Return log h; where a point holds no heat, that of the smallest number."""
    return np.asarray(np.log(np.maximum(signatures, np.finfo(float).tiny)))
