"""Skeletons with flesh: joints in a tree, round cones around bones, poses by linear-blend skinning."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from worker.arrays import FloatArray

Pose = Mapping[str, Sequence[float]]  # joint → turns in degrees about x, y, z, seen in the rest pose


@dataclass(frozen=True, kw_only=True)
class Joint:
    """A place about which everything below it turns."""

    name: str
    parent: int  # index of the joint above; -1 for the root, which is the first
    position: tuple[float, float, float]  # in the rest pose


@dataclass(frozen=True, kw_only=True)
class Flesh:
    """A round cone from start to end, perhaps flattened, that follows one joint."""

    joint: int  # index of the joint that moves it
    start: tuple[float, float, float]
    end: tuple[float, float, float]
    radii: tuple[float, float]  # at start and end
    part: str  # what it is for the colouring: body, eye, foot …
    flat_axis: tuple[float, float, float]  # unit vector along which it is thinner
    flatness: float  # how many times thinner: 1 is round


@dataclass(frozen=True, kw_only=True)
class Body:
    """A creature without colours."""

    kind: str
    joints: tuple[Joint, ...]  # each after its parent
    flesh: tuple[Flesh, ...]
    blend: float  # length over which neighbouring flesh melts together


def move(body: Body, pose: Pose, points: FloatArray, weights: FloatArray) -> FloatArray:
    """Bend a body: every point follows its joints by its weights.

    Parameters
    ----------
    points : (n, 3)
        In the rest pose.
    weights : (n, j)
        Shares of each joint, rows sum to 1.

    Returns
    -------
    moved : (n, 3)
    """
    turns, shifts = transforms(body, pose)
    blended = np.tensordot(weights, turns, 1)  # (n, 3, 3)
    moved: FloatArray = (blended @ points[:, :, None])[:, :, 0] + weights @ shifts
    return moved


def transforms(body: Body, pose: Pose) -> tuple[FloatArray, FloatArray]:
    """Return each joint's rotation (j, 3, 3) and shift (j, 3), from the rest pose to the given one."""
    unknown = set(pose) - {joint.name for joint in body.joints}
    if unknown:
        raise ValueError(f"a {body.kind} has no joint {sorted(unknown)[0]}")
    turns = np.empty((len(body.joints), 3, 3))
    shifts = np.empty((len(body.joints), 3))
    for i, joint in enumerate(body.joints):
        above = (np.eye(3), np.zeros(3)) if joint.parent < 0 else (turns[joint.parent], shifts[joint.parent])
        own = Rotation.from_euler("xyz", pose.get(joint.name, (0.0, 0.0, 0.0)), degrees=True).as_matrix()
        centre = np.array(joint.position)
        turns[i] = above[0] @ own
        shifts[i] = above[0] @ (centre - own @ centre) + above[1]
    return turns, shifts
