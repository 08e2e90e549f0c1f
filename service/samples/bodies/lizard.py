"""A lizard: low, sprawling legs, a long tail, a crest along the back."""

from service.samples.builder import BodyBuilder, Point
from service.samples.proportions import Proportions
from service.samples.skeleton import Body, Pose

POSES: dict[str, Pose] = {
    "resting": {},
    "curling": {
        "spine-1": (0, 24, 0),
        "spine-0": (0, 10, 0),
        "head-0": (0, 20, 0),
        **{f"tail-{i}": (0, -34, 0) for i in range(5)},
    },
    "climbing": {
        "spine-1": (-6, -20, 0),
        "head-0": (-14, 20, 0),
        "foreleg-left-0": (0, -34, 12),
        "foreleg-right-0": (0, -36, 0),
        "hindleg-left-0": (0, 36, 0),
        "hindleg-right-0": (0, 30, -10),
        "tail-0": (0, 24, 0),
        "tail-1": (0, 22, 0),
        "tail-2": (0, -20, 0),
        "tail-3": (0, -36, 0),
        "tail-4": (0, -36, 0),
    },
    "threatening": {
        "spine-1": (-30, 0, 0),
        "head-0": (-14, 0, 0),
        "foreleg-left-0": (0, 0, -34),
        "foreleg-right-0": (0, 0, 34),
        "tail-0": (16, 0, 0),
        "tail-1": (26, 10, 0),
        "tail-2": (30, 16, 0),
        "tail-3": (30, 16, 0),
    },
}


def lizard(shape: Proportions) -> Body:
    """Return a lizard with the given proportions; 2.4 units long."""
    girth, low = shape.girth, 0.26
    builder = BodyBuilder("lizard", (0.0, low, 0.0))
    spine: list[Point] = [(0, low, -0.34), (0, low + 0.02, 0.0), (0, low + 0.03, 0.34)]
    builder.limb("spine", "root", spine, (0.135 * girth, 0.175 * girth, 0.135 * girth))
    builder.cone(
        "spine-0", (0, low - 0.04, -0.2), (0, low - 0.04, 0.05), (0.13 * girth, 0.15 * girth), "belly"
    )
    _head(builder, shape, low)
    tail: list[Point] = [(0, low - 0.012 * i, -0.4 - 0.2 * i * shape.tail) for i in range(6)]
    builder.limb("tail", "root", tail, (0.12 * girth, 0.095, 0.078, 0.062, 0.048, 0.034))
    for i in range(5):
        place, joint = 0.3 - 0.16 * i, "spine-1" if i < 2 else "spine-0"
        back = low + (0.17 - 0.012 * abs(i - 2)) * girth
        tip: Point = (0, back + 0.09, place - 0.07)
        builder.cone(joint, (0, back - 0.03, place), tip, (0.06, 0.026), "accent", ((1, 0, 0), 1.7))
    for name, joint, place in (("foreleg", "spine-1", 0.27), ("hindleg", "spine-0", -0.33)):
        _legs(builder, shape, name, joint, place)
    return builder.build(0.022)


def _head(builder: BodyBuilder, shape: Proportions, low: float) -> None:
    size = shape.head
    start = 0.36 + 0.06 * shape.neck
    builder.limb(
        "head",
        "spine-1",
        [(0, low + 0.05, start), (0, low + 0.06, start + 0.2 * size), (0, low + 0.03, start + 0.38 * size)],
        (0.115, 0.14 * size, 0.085 * size),
    )
    builder.eyes("head-0", (0.1 * size, low + 0.14 * size, start + 0.2 * size), 0.062 * size)


def _legs(builder: BodyBuilder, shape: Proportions, name: str, joint: str, place: float) -> None:
    thick, out = shape.limbs, 0.1 * shape.girth
    points: list[Point] = [
        (out, 0.24, place),
        (out + 0.24 * shape.legs, 0.25, place - 0.05),
        (out + 0.34 * shape.legs, 0.07, place + 0.03),
        (out + 0.42 * shape.legs, 0.045, place + 0.13),
    ]
    builder.limbs(
        name, joint, points, (0.085 * thick, 0.068 * thick, 0.05 * thick, 0.062 * thick), tip="foot"
    )
