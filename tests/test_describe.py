import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tests.shapes import coloured, sphere
from worker.arrays import FloatArray, IntArray
from worker.canonical import Surface, canonical_surface
from worker.describe import describe, describe_surface
from worker.descriptors.signatures import heat_kernel_signatures
from worker.errors import Code, MeshError
from worker.geometry.repair import repair
from worker.parameters import Operator, Parameters
from worker.reading.upload import Upload, read_mesh
from worker.solving import solve_joint

PARAMETERS = Parameters()
SMALL = replace(PARAMETERS, vertices=1_200, distance_samples=300, colour_samples=8_000)
NARROW_AND_WIDE: list[dict[str, Any]] = [{}, {"cutoff": 1.0, "fine_cutoff": 1.0}]
SCRIPT = """
import hashlib, sys
from pathlib import Path
from worker.describe import describe
from worker.reading.upload import Upload
found = describe(Upload(files={"m.obj": Path(sys.argv[1]).read_bytes()}))
digest = hashlib.sha256(found.thumbnail + found.preview)
for part in (found.blocks, found.signatures):
    for name in sorted(part):
        digest.update(part[name].tobytes())
print(digest.hexdigest())
"""


def obj(vertices: FloatArray, faces: IntArray) -> bytes:
    """Write a mesh whose colour runs with its position."""
    colours = np.clip(0.5 + vertices / 4, 0, 1)
    rows = [f"v {' '.join(f'{x:.9g}' for x in [*v, *c])}" for v, c in zip(vertices, colours, strict=True)]
    rows += [f"f {a} {b} {c}" for a, b, c in faces + 1]
    return "\n".join(rows).encode()


def egg(levels: int = 4) -> tuple[FloatArray, IntArray]:
    vertices, faces = sphere(levels)
    return vertices * [1.0, 1.5, 0.8] + 0.2 * np.sin(3 * vertices[:, [1, 2, 0]]), faces


def test_the_same_file_gives_the_same_bytes_in_two_processes(tmp_path: Path) -> None:
    (tmp_path / "egg.obj").write_bytes(obj(*egg()))
    command = [sys.executable, "-c", SCRIPT, str(tmp_path / "egg.obj")]
    digests = {subprocess.run(command, capture_output=True, check=True).stdout for _ in range(2)}
    assert len(digests) == 1


def test_a_description_has_every_block_finite_and_of_its_size() -> None:
    found = describe(Upload(files={"egg.obj": obj(*egg())}), SMALL)
    assert found.fingerprint == SMALL.fingerprint()
    assert found.facts.vertices == 2562
    assert found.facts.components == 1
    assert found.facts.colour == "vertex"
    assert found.blocks["colour-curves"].shape == (144,)
    np.testing.assert_allclose(found.blocks["colour-histogram"].sum(), 1.0, rtol=1e-5)
    for name in ("hks-0", "hks-0.05", "hks-0.1", "log-hks"):
        assert found.signatures[name].shape == (len(found.signatures["areas"]), 6)
    assert found.signatures["diffusion-joint"].shape == (PARAMETERS.distance_quantiles,)
    for array in [*found.blocks.values(), *found.signatures.values()]:
        assert np.isfinite(array).all()


def test_a_mesh_without_faces_is_refused_by_its_code() -> None:
    with pytest.raises(MeshError) as refusal:
        describe(Upload(files={"points.obj": b"v 0 0 0\nv 1 0 0\n"}))
    assert refusal.value.code is Code.NO_FACES


@settings(max_examples=3)
@given(st.integers(0, 2**32 - 1), st.floats(1e-3, 1e3))
def test_turning_moving_and_scaling_a_file_hardly_changes_its_blocks(seed: int, scale: float) -> None:
    random = np.random.default_rng(seed)
    vertices, faces = egg()
    colours = np.clip(0.5 + vertices / 4, 0, 1)
    moved = scale * Rotation.random(rng=random).apply(vertices) + random.uniform(-10, 10, 3)
    blocks, signatures = describe_surface(surface_of(vertices, faces, colours), SMALL)
    other_blocks, other_signatures = describe_surface(surface_of(moved, faces, colours), SMALL)
    assert np.abs(blocks["colour-histogram"] - other_blocks["colour-histogram"]).sum() < 0.02
    np.testing.assert_allclose(
        signatures["eigenvalues-0"][:10], other_signatures["eigenvalues-0"][:10], rtol=0.01, atol=1e-6
    )


def surface_of(vertices: FloatArray, faces: IntArray, colours: FloatArray) -> Surface:
    mesh = coloured(vertices, faces, colours)
    return canonical_surface(mesh, repair(mesh), SMALL)


@pytest.mark.parametrize("weight", [0.0, 0.1])
@pytest.mark.parametrize("operator", list(Operator))
def test_on_a_real_mesh_the_kept_pairs_give_the_hks_of_200(
    weight: float, operator: Operator, data_folder: Path
) -> None:
    path = data_folder / "posed" / "q_animals__ShibaInu" / "pose_03.ply"
    mesh = read_mesh(Upload(files={path.name: path.read_bytes()}))
    surface = canonical_surface(mesh, repair(mesh), PARAMETERS)
    times = np.array(PARAMETERS.times)
    few, many = (
        solve_joint(surface.vertices, surface.faces, surface.lab, weight, parameters)
        for parameters in (replace(PARAMETERS, operator=operator, **more) for more in NARROW_AND_WIDE)
    )
    assert len(few.eigenvalues) < 80
    assert len(many.eigenvalues) >= 200
    expected = heat_kernel_signatures(many.eigenvalues, many.eigenfunctions, times)
    found = heat_kernel_signatures(few.eigenvalues, few.eigenfunctions, times)
    np.testing.assert_allclose(found, expected, rtol=1e-6)
