"""Parcels are what the crash tests compare with: always the same, all different, of every kind."""

import pytest

from service.intake.submissions import MESHES
from soak.parcels import EMPTY, KINDS, kind_of, parcel
from worker.errors import MeshError
from worker.geometry.repair import repair
from worker.reading.mesh import Colour
from worker.reading.upload import Upload, inspect_upload, read_mesh

NUMBERS = range(1, 28)


def test_the_same_number_is_the_same_content_and_no_other_is() -> None:
    contents = [tuple(sorted(parcel(number).values())) for number in NUMBERS]
    assert contents == [tuple(sorted(parcel(number).values())) for number in NUMBERS]
    assert len(set(contents)) == len(contents)


def test_every_kind_comes() -> None:
    assert {kind_of(number) for number in NUMBERS} == set(KINDS)


@pytest.mark.parametrize("number", NUMBERS)
def test_a_parcel_is_accepted_at_the_door_and_judged_by_the_worker(number: int) -> None:
    upload = Upload(files=parcel(number))
    inspect_upload(upload)
    assert any(name.endswith(MESHES) for name in upload.files)
    if kind_of(number) == "empty":
        with pytest.raises(MeshError) as refusal:
            repair(read_mesh(upload))
        assert refusal.value.code == EMPTY
    else:
        mesh = read_mesh(upload)
        assert mesh.colour == (Colour.VERTEX if kind_of(number) == "ply" else Colour.TEXTURE)
        assert repair(mesh).components == 1
