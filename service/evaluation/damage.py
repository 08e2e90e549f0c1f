"""Damage that scans have: holes, missing parts, foreign bodies."""

import numpy as np
from scipy.spatial import ConvexHull

from service.evaluation.joining import append, painted, select_faces
from worker.arrays import FloatArray, IntArray
from worker.geometry.areas import face_vectors
from worker.reading.mesh import Mesh

HOLES = 4  # for each step of strength
HOLE = 0.0015  # area of a hole, as a share of the surface
PART = 0.06  # area of the missing part or of the ball for each step of strength, as a share of the surface
RED = np.array([200, 30, 30]) / 255.0  # of the ball, sRGB
SUNK = 0.2  # of its radius, that the ball sits in the surface
BALL = 1_000  # vertices of the ball


def punch_holes(mesh: Mesh, strength: int, random: np.random.Generator) -> Mesh:
    """Remove small round patches; where all triangles are larger than a patch, nothing."""
    areas = np.linalg.norm(face_vectors(mesh.vertices, mesh.faces), axis=1)
    centres = mesh.vertices[mesh.faces].mean(axis=1)
    hole = HOLE * areas.sum()
    small = np.where(areas <= hole, areas, 0.0)
    kept = np.ones(len(areas), dtype=bool)
    for _ in range(HOLES * strength if small.any() else 0):
        centre = centres[random.choice(len(areas), p=small / small.sum())]
        kept &= (np.linalg.norm(centres - centre, axis=1) > np.sqrt(hole / np.pi)) | (areas > hole)
    return select_faces(mesh, kept)


def cut_away(mesh: Mesh, strength: int, random: np.random.Generator) -> Mesh:
    """Remove what lies furthest in a random direction: the part that a scanner did not see."""
    direction = _direction(random)
    areas = np.linalg.norm(face_vectors(mesh.vertices, mesh.faces), axis=1)
    depths = mesh.vertices[mesh.faces].mean(axis=1) @ direction
    order = np.argsort(depths, kind="stable")
    within = np.cumsum(areas[order]) <= (1.0 - PART * strength) * areas.sum()
    within[0] = True  # never everything, however few the triangles are
    kept = np.empty(len(areas), dtype=bool)
    kept[order] = within
    return select_faces(mesh, kept)


def stick_on_ball(mesh: Mesh, strength: int, random: np.random.Generator) -> Mesh:
    """Put a red ball on the surface, of 6 % of its area for each step of strength."""
    vectors = face_vectors(mesh.vertices, mesh.faces)
    areas = np.linalg.norm(vectors, axis=1)
    if not areas.any():
        return mesh  # no place for a ball; repair refuses it
    radius = np.sqrt(PART * strength * areas.sum() / (4.0 * np.pi))
    face = random.choice(len(areas), p=areas / areas.sum())
    outwards = vectors[face] / areas[face]
    centre = mesh.vertices[mesh.faces[face]].mean(axis=0) + (1.0 - SUNK) * radius * outwards
    vertices, faces = _ball(centre, float(radius))
    return append(mesh, painted(mesh, vertices, faces, np.broadcast_to(RED, (len(faces), 3, 3))))


def _ball(centre: FloatArray, radius: float) -> tuple[FloatArray, IntArray]:
    """Return even points on a sphere, along a Fibonacci spiral, and the triangles of their hull."""
    steps = np.arange(BALL) + 0.5
    heights, angles = 1.0 - 2.0 * steps / BALL, np.pi * (1.0 + np.sqrt(5.0)) * steps
    widths = np.sqrt(1.0 - heights**2)
    points = np.column_stack([widths * np.cos(angles), widths * np.sin(angles), heights])
    faces = ConvexHull(points).simplices.astype(np.int64)
    inwards = np.linalg.det(points[faces]) < 0
    faces[inwards] = faces[inwards][:, ::-1]
    return centre + radius * points, faces


def _direction(random: np.random.Generator) -> FloatArray:
    vector = random.standard_normal(3)
    return np.asarray(vector / np.linalg.norm(vector))
