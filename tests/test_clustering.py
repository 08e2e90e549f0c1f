"""Clustering makes a mesh smaller and keeps its place and its colours."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from worker.pictures.clustering import cluster


@given(seed=st.integers(0, 1000), cubes=st.integers(1, 20))
@settings(max_examples=30)
def test_the_result_is_a_mesh_within_the_old_bounds(seed: int, cubes: int) -> None:
    generator = np.random.default_rng(seed)
    vertices, colours = generator.normal(size=(60, 3)), generator.uniform(size=(60, 3))
    faces = np.array([generator.choice(60, 3, replace=False) for _ in range(100)])
    merged, kept, mixed = cluster(vertices, faces, colours, cubes)
    assert len(merged) == len(mixed) <= 60
    assert len(kept) <= 100
    assert (kept < len(merged)).all()
    assert (merged.min(0) >= vertices.min(0) - 1e-12).all()
    assert (merged.max(0) <= vertices.max(0) + 1e-12).all()
    assert (mixed >= 0).all()
    assert (mixed <= 1 + 1e-12).all()
    assert all(len(set(face)) == 3 for face in kept.tolist())


def test_vertices_of_one_cube_become_their_mean() -> None:
    vertices = np.array([(0, 0, 0), (0.1, 0, 0), (1, 0, 0), (0, 1, 0)], dtype=np.float64)
    colours = np.array([(0, 0, 0), (1, 1, 1), (1, 0, 0), (0, 1, 0)], dtype=np.float64)
    merged, kept, mixed = cluster(vertices, np.array([(0, 2, 3), (0, 1, 2)]), colours, 2)
    assert len(merged) == 3
    assert len(kept) == 1
    np.testing.assert_allclose(merged[0], (0.05, 0, 0))
    np.testing.assert_allclose(mixed[0], (0.5, 0.5, 0.5))
