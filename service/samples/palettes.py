"""The coats of the sample library, and random ones."""

import colorsys

import numpy as np

from service.samples.colouring import PATTERNS, Coat

COATS: dict[str, Coat] = {
    "savannah": Coat(
        name="savannah",
        pattern="patches",
        scale=0.2,
        base="#f3ddae",
        mark="#a8581f",
        belly="#f8ecd2",
        accent="#4a2c17",
        foot="#3b2a20",
        tip="#6b4423",
        seed=4,
    ),
    "zebra": Coat(
        name="zebra",
        pattern="stripes",
        scale=0.17,
        base="#f6f4ee",
        mark="#1d1b22",
        belly="#ffffff",
        accent="#3a3a46",
        foot="#26242b",
        tip="#1d1b22",
        seed=5,
    ),
    "tiger": Coat(
        name="tiger",
        pattern="stripes",
        scale=0.2,
        base="#f08a24",
        mark="#2a1a12",
        belly="#fff3df",
        accent="#3a1d16",
        foot="#fbe3bd",
        tip="#2a1a12",
        seed=8,
    ),
    "jungle": Coat(
        name="jungle",
        pattern="spots",
        scale=0.13,
        base="#3fa34a",
        mark="#f4d03f",
        belly="#d8efb0",
        accent="#e2502c",
        foot="#1f6d3a",
        tip="#1f6d3a",
        seed=2,
    ),
    "ember": Coat(
        name="ember",
        pattern="marble",
        scale=0.22,
        base="#3a1f3d",
        mark="#ff7a2f",
        belly="#7b2d3a",
        accent="#ffd166",
        foot="#1f1226",
        tip="#ff7a2f",
        seed=3,
    ),
    "parrot": Coat(
        name="parrot",
        pattern="dusk",
        scale=0.4,
        base="#e23b3b",
        mark="#c31f3a",
        belly="#ffd54a",
        accent="#f7b500",
        foot="#6d6a75",
        tip="#1f6fd6",
        seed=6,
    ),
    "deep sea": Coat(
        name="deep sea",
        pattern="rings",
        scale=0.16,
        base="#7b4bb7",
        mark="#d77bd0",
        belly="#f6c9dd",
        accent="#ffffff",
        foot="#5d3696",
        tip="#f39ac1",
        seed=1,
    ),
    "reef": Coat(
        name="reef",
        pattern="stripes",
        scale=0.34,
        base="#1495c9",
        mark="#f7f7f2",
        belly="#e9f7fb",
        accent="#ffc93c",
        foot="#ffc93c",
        tip="#ffb01f",
        seed=7,
    ),
}


def random_coat(generator: np.random.Generator) -> Coat:
    """Draw a pattern and a palette of related hues."""
    pattern = str(generator.choice(sorted(PATTERNS)))
    hue = generator.uniform()
    away = hue + generator.choice([0.08, 0.33, 0.5, -0.12])
    dark_first = generator.uniform() < 0.4
    values = (0.45, 0.92) if dark_first else (0.92, 0.4)
    return Coat(
        name="random",
        pattern=pattern,
        scale=float(generator.uniform(0.13, 0.36)),
        base=_hex(hue, generator.uniform(0.05, 0.85), values[0]),
        mark=_hex(away, generator.uniform(0.2, 0.9), values[1]),
        belly=_hex(hue, 0.16, 0.96),
        accent=_hex(away + 0.1, generator.uniform(0.2, 0.9), generator.uniform(0.3, 1.0)),
        foot=_hex(hue, generator.uniform(0.1, 0.8), generator.uniform(0.15, 0.7)),
        tip=_hex(away, generator.uniform(0.2, 0.9), generator.uniform(0.3, 1.0)),
        seed=int(generator.integers(2**31)),
    )


def _hex(hue: float, saturation: float, value: float) -> str:
    return "#" + "".join(f"{round(255 * c):02x}" for c in colorsys.hsv_to_rgb(hue % 1.0, saturation, value))
