"""A walker: upright on two legs, with arms, a big head and round ears."""

from service.samples.builder import BodyBuilder, Point
from service.samples.proportions import Proportions
from service.samples.skeleton import Body, Pose

POSES: dict[str, Pose] = {
    "standing": {},
    "waving": {
        "arm-left-0": (0, 0, 62),
        "arm-left-1": (0, 0, 42),
        "arm-right-0": (0, 0, 24),
        "head-0": (0, -14, 12),
        "spine-1": (0, 0, -7),
    },
    "running": {
        "root": (10, 0, 0),
        "leg-left-0": (-52, 0, 0),
        "leg-left-1": (48, 0, 0),
        "leg-right-0": (34, 0, 0),
        "leg-right-1": (44, 0, 0),
        "arm-left-0": (36, 0, -18),
        "arm-left-1": (-34, -26, 0),
        "arm-right-0": (-44, 0, 18),
        "arm-right-1": (-42, 26, 0),
        "head-0": (-8, 0, 0),
    },
    "sitting": {
        "root": (-12, 0, 0),
        "leg-left-0": (-74, 14, 0),
        "leg-left-1": (26, 0, 0),
        "leg-right-0": (-74, -14, 0),
        "leg-right-1": (44, 0, 0),
        "arm-left-0": (26, 0, -26),
        "arm-right-0": (26, 0, 26),
        "spine-1": (16, 0, 0),
        "head-0": (6, 22, 0),
    },
}


def walker(shape: Proportions) -> Body:
    """Return a walker with the given proportions; 1.9 units tall."""
    hips = 0.78 * shape.legs
    builder = BodyBuilder("walker", (0.0, hips, 0.0))
    girth = shape.girth
    spine: list[Point] = [(0, hips, 0), (0, hips + 0.22, 0), (0, hips + 0.46, -0.01)]
    builder.limb("spine", "root", spine, (0.19 * girth, 0.2 * girth, 0.155 * girth))
    builder.ball("spine-0", (0, hips + 0.12, 0.07 * girth), 0.175 * girth, "belly")
    _head(builder, shape, hips + 0.55)
    thick = shape.limbs
    arm: list[Point] = [
        (0.17 * girth, hips + 0.46, 0),
        (0.17 * girth + 0.24 * shape.legs, hips + 0.3, 0),
        (0.17 * girth + 0.44 * shape.legs, hips + 0.14, 0.04),
        (0.17 * girth + 0.5 * shape.legs, hips + 0.09, 0.06),
    ]
    builder.limbs(
        "arm", "spine-1", arm, (0.085 * thick, 0.07 * thick, 0.058 * thick, 0.095 * thick), tip="foot"
    )
    leg: list[Point] = [
        (0.115 * girth, hips - 0.06, 0),
        (0.14 * girth, hips * 0.5, 0.02),
        (0.15 * girth, 0.1, 0),
    ]
    builder.limbs("leg", "root", leg, (0.125 * thick, 0.092 * thick, 0.075 * thick))
    for side, sign in (("left", 1), ("right", -1)):
        heel, toe = (0.15 * sign * girth, 0.07, -0.01), (0.17 * sign * girth, 0.06, 0.19)
        builder.cone(f"leg-{side}-1", heel, toe, (0.075 * thick, 0.085 * thick), "foot")
    return builder.build(0.028)


def _head(builder: BodyBuilder, shape: Proportions, neck: float) -> None:
    size = shape.head
    top = neck + 0.08 * shape.neck + 0.2 * size
    builder.limb("head", "spine-1", [(0, neck - 0.04, 0), (0, top, 0.01)], (0.13, 0.235 * size))
    builder.ball("head-0", (0, top - 0.06 * size, 0.17 * size), 0.12 * size, "muzzle")
    builder.ball("head-0", (0, top - 0.01 * size, 0.28 * size), 0.045 * size, "accent")
    builder.eyes("head-0", (0.105 * size, top + 0.075 * size, 0.185 * size), 0.062 * size)
    ear: tuple[Point, Point] = ((0.17 * size, top + 0.14 * size, 0), (0.235 * size, top + 0.24 * size, 0))
    builder.limbs("ear", "head-0", ear, (0.075 * size, 0.1 * size), flat=((0, 0, 1), 1.8))
