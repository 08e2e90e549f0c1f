"""A preview's points come back as they were written, and nothing else is taken for one."""

import numpy as np
import pytest

from tests.shapes import sphere
from worker.arrays import FloatArray
from worker.pictures.preview import preview
from worker.pictures.preview_points import NoPreview, read_colours, read_points


def glb(levels: int = 2) -> bytes:
    vertices, faces = sphere(levels)
    return preview(vertices, faces, np.full(vertices.shape, 0.5))


def test_vertices_and_faces_are_those_that_were_written() -> None:
    vertices, faces = sphere(2)
    read_vertices, read_faces = read_points(glb())
    np.testing.assert_allclose(read_vertices, vertices, atol=1e-6)
    np.testing.assert_array_equal(read_faces, faces)


def test_a_mesh_of_many_vertices_keeps_its_indices() -> None:
    rows = np.arange(30_000)
    vertices = np.column_stack([rows, rows**0.5, np.sin(rows)]).astype(float)
    faces = np.column_stack([rows[:1000], rows[:1000] + 28_000, rows[:1000] + 1])
    read_vertices, read_faces = read_points(preview(vertices, faces, np.zeros(vertices.shape)))
    assert read_faces.max() < len(read_vertices)
    assert len(read_faces) > 0


@pytest.mark.parametrize(
    "damaged",
    [
        b"",
        b"glTF",
        b"PK" + glb()[2:],
        glb()[:100],
        glb()[:-20],
        glb().replace(b"POSITION", b"POSITIOM"),
        glb().replace(b'"indices"', b'"indicez"'),
    ],
)
def test_what_is_no_preview_is_refused(damaged: bytes) -> None:
    with pytest.raises(NoPreview):
        read_points(damaged)


def test_colours_come_back_within_half_a_step_of_their_eight_linear_bits() -> None:
    vertices, faces = sphere(2)
    colours = np.random.default_rng(0).random(vertices.shape)
    found = read_colours(preview(vertices, faces, colours))
    assert found.shape == colours.shape
    assert np.abs(_linear(found) - _linear(colours)).max() <= 0.5 / 255 + 1e-9


def _linear(srgb: FloatArray) -> FloatArray:
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def test_what_has_no_colours_is_refused() -> None:
    whole = glb()
    with pytest.raises(NoPreview):
        read_colours(whole.replace(b"COLOR_0", b"COLOR_9"))
