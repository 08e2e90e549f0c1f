"""A fish: a flat tall body, fins, and a forked tail."""

from service.samples.builder import BodyBuilder, Point
from service.samples.proportions import Proportions
from service.samples.skeleton import Body, Pose

SIDE: Point = (1.0, 0.0, 0.0)

POSES: dict[str, Pose] = {
    "still": {},
    "turning": {
        "front-0": (0, 18, 0),
        **{f"tail-{i}": (0, -22, 0) for i in range(3)},
        "fork-0": (0, -24, 0),
        "fin-left-0": (0, 0, 30),
        "fin-right-0": (0, 0, 30),
    },
    "swimming": {
        "front-0": (0, -12, 0),
        "tail-0": (0, -20, 0),
        "tail-1": (0, 26, 0),
        "tail-2": (0, 30, 0),
        "fork-0": (0, 26, 0),
        "fin-left-0": (0, 34, -20),
        "fin-right-0": (0, -34, 20),
    },
    "leaping": {
        "front-0": (-18, 0, 0),
        "tail-0": (14, 0, 0),
        "tail-1": (18, 0, 8),
        "tail-2": (16, 0, 10),
        "fork-0": (16, 0, 12),
        "fin-left-0": (0, 0, -34),
        "fin-right-0": (0, 0, 34),
    },
}


def fish(shape: Proportions) -> Body:
    """Return a fish with the given proportions; 1.8 units long."""
    tall, flat = shape.girth, (SIDE, 1.8)
    builder = BodyBuilder("fish", (0.0, 0.0, 0.0))
    builder.cone("root", (0, 0, -0.08), (0, 0, 0.14), (0.33 * tall, 0.34 * tall), flat=flat)
    builder.cone(
        "root", (0, -0.08 * tall, 0.0), (0, -0.06 * tall, 0.2), (0.27 * tall, 0.26 * tall), "belly", flat
    )
    _head(builder, shape)
    tail: list[Point] = [(0, 0, -0.12)] + [(0, 0.01, -0.12 - 0.19 * i * shape.tail) for i in (1, 2, 3)]
    builder.limb("tail", "root", tail, (0.32 * tall, 0.23 * tall, 0.15, 0.095), flat=flat)
    end = tail[-1][2]
    builder.limb("fork", "tail-2", [(0, 0.02, end), (0, 0.26, end - 0.26)], (0.085, 0.13), "tip", (SIDE, 3.2))
    builder.cone("fork-0", (0, 0, end), (0, -0.24, end - 0.24), (0.085, 0.13), "tip", (SIDE, 3.2))
    _fins(builder, shape)
    return builder.build(0.02)


def _head(builder: BodyBuilder, shape: Proportions) -> None:
    tall, nose = shape.girth, 0.44 + 0.1 * shape.neck
    builder.limb("front", "root", [(0, 0, 0.18), (0, -0.02, nose)], (0.32 * tall, 0.17), flat=(SIDE, 1.6))
    builder.ball("front-0", (0, -0.03, nose + 0.13), 0.078, "muzzle")
    builder.eyes("front-0", (0.125, 0.075, nose - 0.0), 0.075 * shape.head)


def _fins(builder: BodyBuilder, shape: Proportions) -> None:
    tall = 0.3 * shape.girth
    builder.cone("root", (0, tall, 0.12), (0, tall + 0.17, -0.12), (0.1, 0.12), "tip", (SIDE, 3.0))
    builder.cone("root", (0, tall, -0.02), (0, tall + 0.06, -0.26), (0.1, 0.1), "tip", (SIDE, 3.0))
    builder.cone("root", (0, -tall, -0.02), (0, -tall - 0.12, -0.17), (0.08, 0.09), "tip", (SIDE, 3.0))
    fin: tuple[Point, Point] = ((0.13 * shape.girth, -0.08, 0.24), (0.4 * shape.legs, -0.22, 0.04))
    builder.limbs("fin", "front-0", fin, (0.07, 0.135), "tip", ((0.45, 0.88, -0.13), 3.0))
