"""Colour curves are ordered by what is kept as they were when they were made."""

import numpy as np
import pytest

from service.samples.creatures import make_creature
from service.samples.palettes import COATS
from service.samples.writing import ply_bytes
from worker.canonical import canonical_surface
from worker.describe import describe_surface, in_single_precision
from worker.descriptors.orders import curve_orders
from worker.geometry.repair import repair
from worker.intrinsic import describe_triangles
from worker.parameters import Parameters
from worker.reading.upload import Upload, read_mesh


@pytest.mark.parametrize("fine", [(64.0, 256.0, 1024.0, 4096.0), (1024.0, 256.0, 4096.0)])
def test_steps_from_a_known_time_lead_to_the_others(fine: tuple[float, ...]) -> None:
    heat = {time: np.array([3.0, 5.0, 2.0]) / time**0.7 + 1e-4 * np.arange(3) for time in (*fine, 2000.0)}
    parameters = Parameters(times=(2000.0, 1024.0), fine_times=fine, curve_times=(256.0, 1024.0, 4096.0))
    logs = np.log(np.stack([heat[time] for time in fine], axis=1))
    kept = np.stack([heat[2000.0], heat[1024.0]], axis=1)
    found = curve_orders(kept, np.diff(logs, axis=1), parameters)
    expected = np.log(np.stack([heat[time] for time in parameters.curve_times], axis=1))
    np.testing.assert_allclose(found, expected)


def test_orders_made_of_what_is_kept_are_those_of_the_description() -> None:
    parameters = Parameters(vertices=800, distance_samples=100, landmarks=32)
    creature = ply_bytes(make_creature("grazer", COATS["savannah"], n_vertices=2000))
    mesh = read_mesh(Upload(files={"a.ply": creature}))
    surface = canonical_surface(mesh, repair(mesh), parameters)
    intrinsic = describe_triangles(surface.vertices, surface.faces, parameters)
    kept = in_single_precision(describe_surface(surface, parameters, intrinsic)[1])
    heat, rates = (np.asarray(kept[name], np.float64) for name in ("hks-0", "log-hks"))
    found = curve_orders(heat, rates, parameters)
    np.testing.assert_allclose(found, np.log(intrinsic.orders), atol=1e-5)
    assert np.ptp(intrinsic.orders, axis=0).min() > 0
