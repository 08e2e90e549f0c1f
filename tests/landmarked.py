"""Landmarks of imaginary surfaces, made in code: heat by Weyl's law, colours of sRGB."""

from dataclasses import dataclass, replace

import numpy as np

from worker.arrays import IntArray, SingleArray
from worker.descriptors.colour_change import ColourChange
from worker.descriptors.landmarks import LADDER, Landmarks, pack, unpack
from worker.descriptors.registration import Query, query_of
from worker.descriptors.signatures import heat_kernel_signatures
from worker.geometry.colour import srgb_to_lab

AREA = 19_000.0  # square units


@dataclass(frozen=True, kw_only=True, eq=False)
class Marked:
    """A surface's landmarks, as numbers."""

    ladder: SingleArray  # (p, j), log h_t
    lab: SingleArray  # (p, 3)
    shares: SingleArray  # (p,)

    def packed(self) -> SingleArray:
        """Return what a catalogue stores of them."""
        placed = np.column_stack([self.lab, self.shares]).astype(np.float64)
        return pack(self.ladder.astype(np.float64), placed).astype(np.float32)

    def query(self) -> Query:
        """Return them as those of a query."""
        return query_of(self.ladder, self.packed())

    def stored(self) -> Landmarks:
        """Return them as those of a stored shape."""
        return unpack(self.packed())

    def of(self, points: IntArray) -> "Marked":
        """Return some of the points in some order, as if they were all of the surface."""
        shares = self.shares[points]
        return Marked(ladder=self.ladder[points], lab=self.lab[points], shares=shares / shares.sum())

    def relit(self, change: ColourChange) -> "Marked":
        """Return them under another light."""
        return replace(self, lab=change.apply(self.lab.T).T)


def marked(seed: int, n_points: int = 128, size: float = 1.0) -> Marked:
    """Make up a surface; its size is the factor by which its area, and no other, is not the canonical.

    From one end to the other it is thinner and thinner, in four colours.
    """
    random = np.random.default_rng(seed)
    eigenvalues = 4.0 * np.pi / AREA * np.arange(64.0) * random.uniform(0.8, 1.2)  # Weyl (1911)
    places = random.permutation(n_points) / n_points
    functions = random.normal(size=(n_points, 64)) * (0.5 + places[:, None] * np.linspace(0.0, 3.0, 64))
    functions[:, 0] = 1.0  # the constant
    functions /= (AREA * size) ** 0.5
    heat = heat_kernel_signatures(eigenvalues / size, functions, np.array(LADDER))
    palette = random.uniform(0.2, 0.8, (4, 3))
    colours = palette[(4 * places).astype(int)] + random.normal(0.0, 0.02, (n_points, 3))
    shares = random.uniform(0.5, 1.5, n_points)
    return Marked(
        ladder=np.log(heat).astype(np.float32),
        lab=srgb_to_lab(colours.clip(0.1, 0.9)).astype(np.float32),
        shares=(shares / shares.sum()).astype(np.float32),
    )
