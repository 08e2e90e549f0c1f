import numpy as np

from worker.descriptors.signatures import heat_kernel_signatures, log_differences


def test_hks_of_a_flat_torus_is_its_heat_trace_over_its_area() -> None:
    n, period = 24, 2 * np.pi
    x, y = np.meshgrid(*[np.arange(n) * period / n] * 2, indexing="ij")
    waves = [(k, m) for k in range(-6, 7) for m in range(-6, 7)]
    values = np.array([float(k * k + m * m) for k, m in waves])
    # Real orthonormal waves: cos for one half of the (k, m), sin for the other.
    functions = [
        np.cos(k * x + m * y)
        if (k, m) > (0, 0)
        else np.sin(k * x + m * y)
        if (k, m) < (0, 0)
        else x * 0 + 2**-0.5
        for k, m in waves
    ]
    columns = np.stack([f.ravel() for f in functions], axis=1) * np.sqrt(2) / period
    times = np.array([0.3, 1.0])
    expected = np.exp(-np.outer(values, times)).sum(axis=0) / period**2
    np.testing.assert_allclose(heat_kernel_signatures(values, columns, times), np.tile(expected, (n * n, 1)))


def test_a_factor_cancels_in_log_differences() -> None:
    signatures = np.random.default_rng(0).uniform(0.1, 1.0, (20, 7))
    np.testing.assert_allclose(log_differences(signatures), log_differences(3.0 * signatures), atol=1e-12)


def test_a_signature_that_halves_has_log_differences_of_minus_log_2() -> None:
    np.testing.assert_allclose(log_differences(np.array([[4.0, 2.0, 1.0]])), -np.log(2.0))
