"""A grazer: four tall legs, a long neck, horns and a tufted tail."""

from service.samples.builder import BodyBuilder, Point
from service.samples.proportions import Proportions
from service.samples.skeleton import Body, Pose

POSES: dict[str, Pose] = {
    "standing": {},
    "grazing": {
        "neck-0": (52, 0, 0),
        "neck-1": (34, 0, 0),
        "neck-2": (26, 0, 0),
        "head-0": (-8, 0, 0),
        "foreleg-left-0": (-14, 0, 9),
        "foreleg-right-0": (12, 0, -9),
        "tail-0": (-18, 0, 14),
    },
    "walking": {
        "foreleg-left-0": (-34, 0, 0),
        "foreleg-left-1": (10, 0, 0),
        "foreleg-right-0": (20, 0, 0),
        "foreleg-right-1": (32, 0, 0),
        "hindleg-left-0": (30, 0, 0),
        "hindleg-left-1": (18, 0, 0),
        "hindleg-right-0": (-26, 0, 0),
        "hindleg-right-1": (8, 0, 0),
        "neck-0": (16, 0, 0),
        "neck-1": (-12, 0, 0),
        "tail-0": (22, 0, -12),
    },
    "looking back": {
        "neck-0": (-6, 34, 0),
        "neck-1": (0, 36, 0),
        "neck-2": (10, 34, 0),
        "head-0": (8, 24, 0),
        "hindleg-right-0": (-20, 0, 0),
        "tail-0": (0, 0, 38),
        "tail-1": (0, 0, 24),
    },
}


def grazer(shape: Proportions) -> Body:
    """Return a grazer with the given proportions; 2 units tall."""
    height = 0.98 * shape.legs
    builder = BodyBuilder("grazer", (0.0, height, 0.0))
    girth = 0.2 * shape.girth
    builder.cone("root", (0, height, -0.3), (0, height + 0.03, 0.3), (girth, girth * 1.05))
    builder.cone("root", (0, height - 0.05, -0.1), (0, height - 0.05, 0.1), (girth, girth), "belly")
    _neck_and_head(builder, shape, height)
    for name, place in (("foreleg", 0.31), ("hindleg", -0.33)):
        _legs(builder, shape, name, place, height)
    tail: list[Point] = [(0, height + 0.08, -0.42)]
    tail += [(0, height - 0.14 * shape.tail, -0.62), (0, height - 0.42 * shape.tail, -0.68)]
    builder.limb("tail", "root", tail, (0.055, 0.034, 0.065), tip="accent")
    return builder.build(0.026)


def _neck_and_head(builder: BodyBuilder, shape: Proportions, height: float) -> None:
    base = height + 0.1
    steps = [(0.0, 0.33), (0.3, 0.47), (0.6, 0.56), (0.84, 0.61)]
    points: list[Point] = [(0, base + up * shape.neck, forward) for up, forward in steps]
    thick = shape.limbs
    builder.limb("neck", "root", points, (0.16 * thick, 0.115 * thick, 0.095 * thick, 0.09 * thick))
    (_, top, front), size = points[-1], shape.head
    builder.limb(
        "head",
        "neck-2",
        [(0, top, front), (0, top - 0.06 * size, front + 0.3 * size)],
        (0.115 * size, 0.075 * size),
    )
    builder.cone(
        "head-0",
        (0, top - 0.055 * size, front + 0.26 * size),
        (0, top - 0.07 * size, front + 0.33 * size),
        (0.082 * size, 0.075 * size),
        "muzzle",
    )
    builder.eyes("head-0", (0.088 * size, top + 0.05 * size, front + 0.1 * size), 0.046 * size)
    ear: tuple[Point, Point] = (
        (0.08 * size, top + 0.09 * size, front - 0.02),
        (0.25 * size, top + 0.15 * size, front - 0.06),
    )
    builder.limbs("ear", "head-0", ear, (0.04 * size, 0.055 * size), flat=((0, 0.35, 0.94), 1.7))
    horn: tuple[Point, Point] = (
        (0.045 * size, top + 0.1 * size, front),
        (0.06 * size, top + 0.29 * size, front - 0.03),
    )
    builder.limbs("horn", "head-0", horn, (0.03 * size, 0.042 * size), part="accent")


def _legs(builder: BodyBuilder, shape: Proportions, name: str, place: float, height: float) -> None:
    points: list[Point] = [
        (0.12 * shape.girth, height - 0.06, place),
        (0.13 * shape.girth, height * 0.5, place + 0.02),
        (0.13 * shape.girth, 0.13, place),
        (0.13 * shape.girth, 0.06, place + 0.015),
    ]
    thick = shape.limbs
    radii = (0.115 * thick, 0.07 * thick, 0.055 * thick, 0.07 * thick)
    builder.limbs(name, "root", points, radii, tip="foot")
