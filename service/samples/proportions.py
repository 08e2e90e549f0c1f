"""How one animal differs from the next of its kind."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, kw_only=True)
class Proportions:
    """Factors on the lengths and widths of a kind; 1 is the typical animal."""

    legs: float = 1.0  # length of legs or arms
    neck: float = 1.0  # length of the neck, or height of the head above the body
    tail: float = 1.0  # length of the tail
    girth: float = 1.0  # thickness of the trunk
    limbs: float = 1.0  # thickness of limbs
    head: float = 1.0  # size of the head and what is on it


def random_proportions(generator: np.random.Generator) -> Proportions:
    """Draw factors between about 0.7 and 1.4."""
    legs, neck, tail, girth, limbs, head = np.exp(generator.uniform(-0.33, 0.33, 6))
    return Proportions(
        legs=float(legs),
        neck=float(neck),
        tail=float(tail),
        girth=float(girth),
        limbs=float(np.clip(limbs, 0.85, 1.3)),
        head=float(np.clip(head, 0.8, 1.25)),
    )
