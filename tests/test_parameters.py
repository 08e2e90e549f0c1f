from dataclasses import fields, replace
from typing import Any

import pytest

from worker.parameters import Operator, Parameters


@pytest.mark.parametrize("name", [field.name for field in fields(Parameters)])
def test_every_number_changes_the_fingerprint(name: str) -> None:
    parameters = Parameters()
    changed: dict[str, Any] = {name: getattr(parameters, name) * 2}
    if name == "operator":
        changed = {name: Operator.MESH_LAPLACE}
    assert replace(parameters, **changed).fingerprint() != parameters.fingerprint()


def test_the_scales_of_the_paper_form_a_geometric_progression() -> None:
    times = Parameters().times
    assert [round(1024 * 4 ** (k / 5), 1) for k in range(6)] == list(times)
