"""An octopus: a tall mantle on eight tapering arms."""

import math

from service.samples.builder import BodyBuilder, Point
from service.samples.proportions import Proportions
from service.samples.skeleton import Body, Pose

ARMS = 8
PIECES = 5  # joints along an arm


def _curls(lift: float, twist: float, wave: float) -> dict[str, tuple[float, float, float]]:
    """Bend all arms by degrees at each joint.

    ``lift`` raises them, ``twist`` swirls them, ``wave`` sets neighbours apart.
    """
    pose = {}
    for arm in range(ARMS):
        angle = 2 * math.pi * (arm + 0.5) / ARMS
        up = lift + wave * (-1) ** arm
        for piece in range(PIECES):
            share = up if piece else 0.6 * up
            pose[f"arm{arm}-{piece}"] = (-share * math.cos(angle), twist, share * math.sin(angle))
    return pose


POSES: dict[str, Pose] = {
    "sitting": {},
    "swimming": {"root": (14, 0, 0), "mantle-0": (10, 0, 0), **_curls(-17, 0, 0)},
    "reaching": {"mantle-0": (-10, 0, 8), **_curls(14, 0, 16)},
    "swirling": {"mantle-0": (0, 0, -12), **_curls(5, 26, 0)},
}


def octopus(shape: Proportions) -> Body:
    """Return an octopus with the given proportions; 1.2 units tall."""
    low, size, girth = 0.22, shape.head, shape.girth
    builder = BodyBuilder("octopus", (0.0, low, 0.0))
    builder.ball("root", (0, low + 0.05, 0), 0.2 * girth)
    top = low + 0.26 + 0.3 * shape.neck * size
    builder.limb("mantle", "root", [(0, low + 0.14, 0), (0, top, -0.08)], (0.2 * girth, 0.31 * size))
    builder.ball("mantle-0", (0, top + 0.14 * size, -0.14), 0.26 * size)
    builder.eyes("root", (0.13 * girth, low + 0.25, 0.15 * girth), 0.085 * size)
    for arm in range(ARMS):
        _arm(builder, shape, arm, low)
    return builder.build(0.026)


def _arm(builder: BodyBuilder, shape: Proportions, arm: int, low: float) -> None:
    angle = 2 * math.pi * (arm + 0.5) / ARMS
    out = [0.12 + 0.19 * i * shape.legs for i in range(PIECES + 1)]
    fall = [0.0, -0.06, -0.12, -0.14, -0.13, -0.07]
    points: list[Point] = [
        (r * math.sin(angle), low + drop, r * math.cos(angle)) for r, drop in zip(out, fall, strict=True)
    ]
    thick = shape.limbs
    radii = [thick * r for r in (0.1, 0.086, 0.07, 0.057, 0.046, 0.036)]
    builder.limb(f"arm{arm}", "root", points, radii, tip="tip")
