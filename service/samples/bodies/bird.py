"""A bird: a round body on two legs, spread wings, a fan of a tail and a beak."""

from service.samples.builder import BodyBuilder, Point
from service.samples.proportions import Proportions
from service.samples.skeleton import Body, Pose

POSES: dict[str, Pose] = {
    "spread": {},
    "flying": {
        "root": (46, 0, 0),
        "wing-left-0": (0, 0, 34),
        "wing-left-1": (0, 0, -22),
        "wing-right-0": (0, 0, -34),
        "wing-right-1": (0, 0, 22),
        "leg-left-0": (38, 0, 0),
        "leg-right-0": (38, 0, 0),
        "neck-0": (-26, 0, 0),
        "tail-0": (-14, 0, 0),
    },
    "gliding": {
        "root": (30, 0, 18),
        "wing-left-0": (0, 14, -24),
        "wing-left-1": (0, 24, 14),
        "wing-right-0": (0, -14, 24),
        "wing-right-1": (0, -24, -14),
        "leg-left-0": (58, 0, 0),
        "leg-right-0": (58, 0, 0),
        "neck-0": (-18, 16, 0),
    },
    "pecking": {
        "root": (34, 0, 0),
        "neck-0": (38, 0, 0),
        "head-0": (22, 14, 0),
        "wing-left-0": (-10, 38, -16),
        "wing-left-1": (0, 44, 0),
        "wing-right-0": (-10, -38, 16),
        "wing-right-1": (0, -44, 0),
        "leg-left-0": (-44, 0, 0),
        "leg-right-0": (-18, 0, 0),
        "tail-0": (-24, 0, 0),
    },
}


def bird(shape: Proportions) -> Body:
    """Return a bird with the given proportions; 1.6 units tall."""
    leg, girth = 0.42 * shape.legs, shape.girth
    centre = leg + 0.26
    builder = BodyBuilder("bird", (0.0, centre, 0.0))
    builder.cone("root", (0, centre - 0.02, -0.16), (0, centre + 0.1, 0.1), (0.19 * girth, 0.25 * girth))
    builder.ball("root", (0, centre, 0.1), 0.24 * girth, "belly")
    _neck_and_head(builder, shape, centre)
    span = shape.limbs
    wing: list[Point] = [
        (0.16 * girth, centre + 0.16, 0.03),
        (0.16 * girth + 0.38 * span, centre + 0.3, -0.03),
        (0.16 * girth + 0.72 * span, centre + 0.4, -0.14),
    ]
    builder.limbs("wing", "root", wing, (0.13, 0.18, 0.1), flat=((-0.34, 0.94, 0.0), 4.0), tip="tip")
    tail: list[Point] = [(0, centre - 0.03, -0.28), (0, centre + 0.02, -0.34 - 0.3 * shape.tail)]
    builder.limb("tail", "root", tail, (0.1, 0.2), part="tip", flat=((0, 0.98, 0.17), 4.0))
    legs: list[Point] = [(0.1, leg + 0.08, -0.02), (0.11, leg * 0.5, -0.02), (0.11, 0.05, 0.0)]
    builder.limbs("leg", "root", legs, (0.062, 0.042, 0.042), part="foot")
    for side, sign in (("left", 1), ("right", -1)):
        for spread in (-0.1, 0.0, 0.1):
            toe: Point = (sign * 0.11 + spread, 0.04, 0.17 - abs(spread) * 0.4)
            builder.cone(f"leg-{side}-1", (sign * 0.11, 0.045, 0.0), toe, (0.042, 0.034), "foot")
    return builder.build(0.02)


def _neck_and_head(builder: BodyBuilder, shape: Proportions, centre: float) -> None:
    size, top = shape.head, centre + 0.3 + 0.16 * shape.neck
    builder.limb("neck", "root", [(0, centre + 0.16, 0.16), (0, top, 0.22)], (0.16, 0.115))
    builder.limb("head", "neck-0", [(0, top, 0.22), (0, top + 0.09 * size, 0.26)], (0.12, 0.175 * size))
    crown, face = top + 0.09 * size, 0.26
    builder.cone(
        "head-0",
        (0, crown - 0.03 * size, face + 0.14 * size),
        (0, crown - 0.09 * size, face + 0.36 * size),
        (0.085 * size, 0.03 * size),
        "accent",
    )
    builder.eyes("head-0", (0.115 * size, crown + 0.055 * size, face + 0.1 * size), 0.058 * size)
    for i in range(3):
        root: Point = (0, crown + 0.14 * size, face - 0.05 * i * size)
        tip: Point = (0, crown + (0.33 - 0.05 * i) * size, face - (0.1 + 0.11 * i) * size)
        builder.cone("head-0", root, tip, (0.03 * size, 0.042 * size), "accent")
