from pathlib import Path

import pytest

from benchmarks.retrieval import Described, describe_folder, mean_reciprocal_ranks
from index.vocabulary import default_vocabulary


@pytest.fixture(scope="module")
def meshes(data_folder: Path) -> list[Described]:
    return describe_folder(data_folder, workers=2)


def test_every_mesh_is_accepted_and_poses_find_their_model(
    meshes: list[Described], data_folder: Path
) -> None:
    assert len(meshes) == len([*data_folder.glob("posed/*/*.ply"), *data_folder.glob("clutter/*.ply")])
    found = mean_reciprocal_ranks(meshes, default_vocabulary())
    assert found["fused"] >= 0.99
    assert found["chks"] >= 0.70
    assert found["chks"] >= found["hks"]  # colour helps
