"""Round cones as fields: how far a point is from each, and all of them melted into one skin."""

from functools import cached_property

import numpy as np

from service.samples.skeleton import Body
from worker.arrays import BoolArray, FloatArray, IntArray

CHUNK = 4_000  # points at a time, so that the (points, cones) arrays stay in the cache
MELTED = 2.0  # blends by which the skin is outside its cones, where up to seven meet: log 7


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
        along = points @ self.steps.T  # ⟨x − a, b⟩, (n, p)
        along -= (self.starts * self.steps).sum(1)
        share = np.clip(along / self.lengths, 0.0, 1.0)
        squares = points @ (-2 * self.starts.T)
        squares += (points**2).sum(1)[:, None]
        squares += (self.starts**2).sum(1)
        squares += share * (share * self.lengths - 2 * along)
        flat = np.flatnonzero(self.flatness > 1)
        if len(flat):
            squares[:, flat] += self._flattening(points, share[:, flat], flat)
        distances: FloatArray = np.sqrt(np.maximum(squares, 0.0, out=squares), out=squares)
        distances -= self.radii[:, 0] + share * (self.radii[:, 1] - self.radii[:, 0])
        return distances

    def _flattening(self, points: FloatArray, share: FloatArray, flat: IntArray) -> FloatArray:
        """Return (f² − 1)⟨x − q, u⟩², (n, f), for the cones that are flat."""
        axes, starts, steps = self.axes[flat], self.starts[flat], self.steps[flat]
        across = points @ axes.T - (starts * axes).sum(1) - share * (steps * axes).sum(1)
        result: FloatArray = (self.flatness[flat] ** 2 - 1) * across**2
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

    def near(self, points: FloatArray, radius: float) -> BoolArray:
        """Say for each point (n,) whether the skin may pass within ``radius`` of it."""
        tapers = np.diff(self.radii, axis=1)[:, 0] / np.sqrt(self.lengths)
        slopes = np.hypot(self.flatness, np.minimum(np.abs(tapers), 1.0))  # how fast distances grow at most
        distances = self.distances(points)
        outside = ((distances - MELTED * self.body.blend) / slopes).min(1) > radius
        inside = (distances / slopes).min(1) < -radius
        return np.asarray(~(outside | inside))
