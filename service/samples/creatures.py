"""Creatures: a body of some kind, tessellated anew for each pose, bent, and wearing a coat."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from service.samples.bodies.bird import POSES as BIRD_POSES
from service.samples.bodies.bird import bird
from service.samples.bodies.fish import POSES as FISH_POSES
from service.samples.bodies.fish import fish
from service.samples.bodies.grazer import POSES as GRAZER_POSES
from service.samples.bodies.grazer import grazer
from service.samples.bodies.lizard import POSES as LIZARD_POSES
from service.samples.bodies.lizard import lizard
from service.samples.bodies.octopus import POSES as OCTOPUS_POSES
from service.samples.bodies.octopus import octopus
from service.samples.bodies.walker import POSES as WALKER_POSES
from service.samples.bodies.walker import walker
from service.samples.colouring import Coat
from service.samples.flesh import Skin
from service.samples.painting import paint
from service.samples.proportions import Proportions
from service.samples.shell import Shell, triangles
from service.samples.skeleton import Body, Pose, move
from service.samples.surface import polygonise


@dataclass(frozen=True, kw_only=True)
class Kind:
    """A kind of creature."""

    body: Callable[[Proportions], Body]
    poses: Mapping[str, Pose]  # by name; the first is the rest pose


KINDS: Mapping[str, Kind] = {
    "grazer": Kind(body=grazer, poses=GRAZER_POSES),
    "walker": Kind(body=walker, poses=WALKER_POSES),
    "lizard": Kind(body=lizard, poses=LIZARD_POSES),
    "bird": Kind(body=bird, poses=BIRD_POSES),
    "octopus": Kind(body=octopus, poses=OCTOPUS_POSES),
    "fish": Kind(body=fish, poses=FISH_POSES),
}


def make_creature(
    kind: str,
    coat: Coat,
    pose: Pose | None = None,
    *,
    proportions: Proportions | None = None,
    n_vertices: int = 6000,
    offset: float = 0.0,
) -> Shell:
    """Make a coloured creature.

    Parameters
    ----------
    kind : str
        A key of `KINDS`.
    pose : Pose, optional
        Turns of joints; the rest pose where none is given.
    n_vertices : int
        About how many vertices it gets.
    offset : float
        Shifts the grid of the tessellation, in 0…1: the same body, other vertices.
    """
    skin = Skin(KINDS[kind].body(proportions or Proportions()))
    lower, upper = skin.bounds
    rest, quads = polygonise(skin, lower, upper, n_vertices=n_vertices, offset=offset)
    vertices = move(skin.body, pose or {}, rest, skin.weights(rest))
    return Shell(vertices=vertices, rest=rest, faces=triangles(rest, quads), paint=partial(paint, skin, coat))


def random_pose(kind: str, generator: np.random.Generator, jitter: float = 8.0) -> Pose:
    """Draw a pose: a mixture of the named ones, each joint turned by some more degrees."""
    named = list(KINDS[kind].poses.values())
    shares = generator.dirichlet(np.full(len(named), 0.5))
    mixed: dict[str, list[float]] = {}
    for joint in KINDS[kind].body(Proportions()).joints:
        turns = [
            share * np.array(pose.get(joint.name, (0, 0, 0)))
            for share, pose in zip(shares, named, strict=True)
        ]
        mixed[joint.name] = list(np.sum(turns, 0) + generator.normal(0, jitter, 3))
    return mixed
