"""Puts bodies together: joints, limbs, and pairs of limbs mirrored at the plane x = 0."""

from collections.abc import Sequence
from itertools import pairwise

from service.samples.skeleton import Body, Flesh, Joint

Point = tuple[float, float, float]
UP: Point = (0.0, 1.0, 0.0)


class BodyBuilder:
    """Collects joints and flesh; creatures look along +z, y is up, +x is their left.

    Parameters
    ----------
    kind : str
    root : tuple of three floats
        Position of the first joint, called ``root``.
    """

    def __init__(self, kind: str, root: Point) -> None:
        self._kind = kind
        self._joints = [Joint(name="root", parent=-1, position=root)]
        self._flesh: list[Flesh] = []

    def _joint(self, name: str) -> int:
        return next(i for i, joint in enumerate(self._joints) if joint.name == name)

    def cone(
        self,
        joint: str,
        start: Point,
        end: Point,
        radii: tuple[float, float],
        part: str = "body",
        flat: tuple[Point, float] = (UP, 1.0),
    ) -> None:
        """Put a round cone on a joint; ``flat`` is an axis and how many times thinner it is along it."""
        flesh = Flesh(
            joint=self._joint(joint),
            start=start,
            end=end,
            radii=radii,
            part=part,
            flat_axis=flat[0],
            flatness=flat[1],
        )
        self._flesh.append(flesh)

    def ball(self, joint: str, centre: Point, radius: float, part: str = "body") -> None:
        """Put a ball on a joint that exists."""
        self.cone(joint, centre, centre, (radius, radius), part)

    def limb(
        self,
        name: str,
        parent: str,
        points: Sequence[Point],
        radii: Sequence[float],
        part: str = "body",
        flat: tuple[Point, float] = (UP, 1.0),
        tip: str | None = None,
    ) -> None:
        """Add a chain of joints ``name-0``, ``name-1`` … at all points but the last, with flesh between them.

        ``tip`` is the part of the last piece, where it differs.
        """
        above = parent
        for i, (start, end) in enumerate(pairwise(points)):
            joint = f"{name}-{i}"
            self._joints.append(Joint(name=joint, parent=self._joint(above), position=start))
            last = i == len(points) - 2
            self.cone(joint, start, end, (radii[i], radii[i + 1]), tip if tip and last else part, flat)
            above = joint

    def limbs(
        self,
        name: str,
        parent: str,
        points: Sequence[Point],
        radii: Sequence[float],
        part: str = "body",
        flat: tuple[Point, float] = (UP, 1.0),
        tip: str | None = None,
    ) -> None:
        """Add a limb ``name-left`` and its mirror image ``name-right``."""
        self.limb(f"{name}-left", parent, points, radii, part, flat, tip)
        axis = mirrored(flat[0])
        self.limb(f"{name}-right", parent, [mirrored(p) for p in points], radii, part, (axis, flat[1]), tip)

    def eyes(self, joint: str, centre: Point, radius: float) -> None:
        """Put two eyes on a head, the given one and its mirror image."""
        self.ball(joint, centre, radius, "eye")
        self.ball(joint, mirrored(centre), radius, "eye")

    def build(self, blend: float) -> Body:
        """Return the body, its flesh melted over the length ``blend``."""
        return Body(kind=self._kind, joints=tuple(self._joints), flesh=tuple(self._flesh), blend=blend)


def mirrored(point: Point) -> Point:
    """Return the point on the creature's other side."""
    return (-point[0], point[1], point[2])
