"""Which faces to turn, so that neighbours agree on what is outside."""

import numpy as np

from worker.arrays import BoolArray, IntArray
from worker.compiled import compiled
from worker.geometry.edges import Edges


def flipped_faces(faces: IntArray, edges: Edges) -> tuple[BoolArray, bool]:
    """Return which faces to turn.

    Faces that meet along an edge of two are joined to pieces, in which every face is known as turned or not
    relative to the first. Of the two ways to turn a piece, the one that leaves more faces as they are is
    taken; where they are as many, the one that leaves the first. A piece that contradicts itself (a Möbius
    strip) stays as it is.

    Parameters
    ----------
    faces : IntArray
        (m, 3); edges of more than two faces connect nothing.
    edges : Edges
        Of these faces.

    Returns
    -------
    flipped : BoolArray
        (m,)
    orientable : bool
        Whether every piece could be oriented.
    """
    flipped = np.zeros(len(faces), dtype=np.bool_)
    one_sided = _turn_pieces(faces, edges.of_faces, edges.n_faces, flipped)
    return flipped, not one_sided


@compiled
def _turn_pieces(faces: IntArray, of_faces: IntArray, n_faces: IntArray, flipped: BoolArray) -> bool:
    """Find the faces to turn; return whether a piece has one side only."""
    parents, turns = np.arange(len(faces)), np.zeros(len(faces), dtype=np.int64)
    contradicted = np.zeros(len(faces), dtype=np.bool_)
    met = np.full(len(n_faces), -1)  # the first corner that was met at each edge
    for corner in range(faces.size):
        edge = of_faces[corner // 3, corner % 3]
        if n_faces[edge] == 2 and met[edge] >= 0:
            agree = _start(faces, corner) != _start(faces, met[edge])
            _join(parents, turns, contradicted, corner // 3, met[edge] // 3, 0 if agree else 1)
        met[edge] = corner
    balance = np.zeros(len(faces), dtype=np.int64)  # faces as the first one less turned ones, by the first
    for face in range(len(faces)):
        first, turn = _root(parents, turns, face)
        balance[first] += 1 - 2 * turn
    for face in range(len(faces)):
        first, turn = _root(parents, turns, face)
        if not contradicted[first]:
            flipped[face] = (turn == 1) == (balance[first] >= 0)
    return bool(contradicted.any())


@compiled
def _start(faces: IntArray, corner: int) -> int:
    return int(faces[corner // 3, corner % 3])


@compiled
def _root(parents: IntArray, turns: IntArray, face: int) -> tuple[int, int]:
    """Return the first face of a piece, and whether (1) a face is turned relative to it."""
    turn, member = 0, face
    while parents[member] != member:
        turn ^= turns[member]
        member = parents[member]
    root, rest = member, turn
    while parents[face] != root and face != root:  # let the way be short next time
        above, step = parents[face], turns[face]
        parents[face], turns[face] = root, rest
        rest ^= step
        face = above
    return root, turn


@compiled
def _join(
    parents: IntArray, turns: IntArray, contradicted: BoolArray, one: int, other: int, differ: int
) -> None:
    """Join the pieces of two faces that are turned alike (0) or not (1)."""
    first, first_turn = _root(parents, turns, one)
    second, second_turn = _root(parents, turns, other)
    differ ^= first_turn ^ second_turn
    if first == second:
        contradicted[first] |= differ == 1
        return
    low, high = min(first, second), max(first, second)
    parents[high], turns[high] = low, differ
    contradicted[low] |= contradicted[high]
