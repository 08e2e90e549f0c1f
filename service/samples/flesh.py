"""Round cones as fields: how far a point is from each, and all of them melted into one skin."""

from functools import cached_property

import numpy as np

from service.samples.skeleton import Body
from worker.arrays import FloatArray, IntArray

CHUNK = 20_000  # points at a time, so that the (points, cones) arrays stay in the cache


class Skin:
    """The smooth union of a body's flesh, ready to be evaluated at many points.

    Parameters
    ----------
    body : Body
    """

    def __init__(self, body: Body) -> None:
        self.body = body
        self.starts = np.array([f.start for f in body.flesh])  # (p, 3)
        self.steps = np.array([f.end for f in body.flesh]) - self.starts  # (p, 3)
        self.radii = np.array([f.radii for f in body.flesh])  # (p, 2)
        self.axes = np.array([f.flat_axis for f in body.flesh])  # (p, 3)
        self.flatness = np.array([f.flatness for f in body.flesh])  # (p,)
        self.lengths = np.maximum((self.steps**2).sum(1), 1e-12)  # squared, (p,)

    def distances(self, points: FloatArray) -> FloatArray:
        """Return approximate signed distances (n, p) to each round cone.

        For the nearest point q = a + s b of a cone's axis: √(|x − q|² + (f² − 1)⟨x − q, u⟩²) − r(s),
        with f the flatness along u.
        """
        along = points @ self.steps.T - (self.starts * self.steps).sum(1)  # ⟨x − a, b⟩, (n, p)
        share = np.clip(along / self.lengths, 0.0, 1.0)
        squares = (points**2).sum(1)[:, None] - 2 * points @ self.starts.T + (self.starts**2).sum(1)
        squares = squares - 2 * share * along + share**2 * self.lengths
        across = (
            points @ self.axes.T - (self.starts * self.axes).sum(1) - share * (self.steps * self.axes).sum(1)
        )
        squares = np.maximum(squares + (self.flatness**2 - 1) * across**2, 0.0)
        radii = self.radii[:, 0] + share * (self.radii[:, 1] - self.radii[:, 0])
        result: FloatArray = np.sqrt(squares) - radii
        return result

    def __call__(self, points: FloatArray) -> FloatArray:
        """Return the melted field (n,): −k log Σ exp(−d/k), negative inside."""
        parts = [self._melt(points[i : i + CHUNK]) for i in range(0, len(points), CHUNK)]
        return np.concatenate(parts) if parts else np.empty(0)

    def _melt(self, points: FloatArray) -> FloatArray:
        distances = self.distances(points)
        nearest = distances.min(1)
        sums = np.exp((nearest[:, None] - distances) / self.body.blend).sum(1)
        melted: FloatArray = nearest - self.body.blend * np.log(sums)
        return melted

    def weights(self, points: FloatArray) -> FloatArray:
        """Return each joint's share (n, j) of each point, smooth over the joints' neighbourhoods."""
        distances = self.distances(points)  # (n, p)
        closest = np.full((len(points), len(self.body.joints)), np.inf)
        for column, flesh in enumerate(self.body.flesh):
            joint = flesh.joint
            closest[:, joint] = np.minimum(closest[:, joint], distances[:, column])
        width = 1.2 * self.body.blend
        shares = np.exp((closest.min(1, keepdims=True) - closest) / width)
        result: FloatArray = shares / shares.sum(1, keepdims=True)
        return result

    def nearest(self, points: FloatArray) -> IntArray:
        """Return the index of the flesh (n,) that each point belongs to."""
        return np.asarray(self.distances(points).argmin(1))

    @cached_property
    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Lower and upper corner (3,) of a box around the skin."""
        margin = self.radii.max(1)[:, None] + 2 * self.body.blend
        ends = self.starts + self.steps
        return (np.minimum(self.starts, ends) - margin).min(0), (np.maximum(self.starts, ends) + margin).max(
            0
        )

    @cached_property
    def steepness(self) -> float:
        """A bound on the length of the field's gradient."""
        tapers = np.abs(np.diff(self.radii, axis=1)[:, 0]) / np.sqrt(self.lengths)
        return float(self.flatness.max() + np.minimum(tapers, 1.0).max())
