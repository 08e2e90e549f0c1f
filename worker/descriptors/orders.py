"""Orders: the heat kernel signatures by which colour curves are ordered, from those that are kept."""

import numpy as np

from worker.arrays import FloatArray
from worker.descriptors.signatures import log_of
from worker.parameters import Parameters


def curve_orders(heat: FloatArray, rates: FloatArray, parameters: Parameters) -> FloatArray:
    """Return log h at the times of the colour curves, which order points as h does.

    What is kept are h at the times of cHKS and the differences of log h between those of the log-HKS words:
    steps from a time of both lead to any of the latter.

    Parameters
    ----------
    heat : (n, t) array
        h at ``parameters.times``, η = 0.
    rates : (n, f − 1) array
        log h at each of ``parameters.fine_times`` less that at the one before.
    parameters : Parameters

    Returns
    -------
    (n, c) array
    """
    known = next(time for time in parameters.times if time in parameters.fine_times)
    start = log_of(heat[:, parameters.times.index(known)])
    climbed = np.cumsum(np.pad(rates, [(0, 0), (1, 0)]), axis=1)  # (n, f), since the first of the fine times
    at = [climbed[:, parameters.fine_times.index(time)] for time in (known, *parameters.curve_times)]
    return np.stack([start + here - at[0] for here in at[1:]], axis=1)
