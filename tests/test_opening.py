"""Of the files that were sent, exactly one is the mesh."""

import pytest

from worker.errors import Code, MeshError
from worker.reading.opening import archive_name, mesh_name, sent_files


@pytest.mark.parametrize("names", [["m.obj"], ["a/M.PLY", "t.png"], ["m.obj", "m.mtl", "ply"]])
def test_the_one_mesh_is_found(names: list[str]) -> None:
    assert mesh_name(names) == names[0]


@pytest.mark.parametrize(
    ("names", "code"),
    [([], Code.NO_MESH), (["readme.txt"], Code.NO_MESH), (["a.obj", "b.ply"], Code.SEVERAL_MESHES)],
)
def test_none_or_several_are_refused_with_their_names(names: list[str], code: Code) -> None:
    with pytest.raises(MeshError) as caught:
        mesh_name(names)
    assert caught.value.code == code
    assert all(name in caught.value.detail for name in names)


def test_a_zip_comes_alone() -> None:
    assert archive_name({"a.ZIP": b""}) == "a.ZIP"
    assert archive_name({"a.obj": b"", "b.mtl": b""}) is None
    with pytest.raises(MeshError, match="alone"):
        archive_name({"a.zip": b"", "b.mtl": b""})


def test_loose_files_get_plain_paths_and_hidden_ones_are_left_out() -> None:
    sent = {".\\a\\m.obj": b"1", "a/./b/../t.png": b"2", "a/._m.obj": b"3"}
    assert sent_files(sent) == {"a/m.obj": b"1", "a/t.png": b"2"}


@pytest.mark.parametrize("name", ["../m.obj", "/etc/passwd", "C:\\m.obj", "", "a\0b"])
def test_a_file_name_that_leaves_the_upload_is_refused(name: str) -> None:
    with pytest.raises(MeshError) as caught:
        sent_files({name: b""})
    assert caught.value.code == Code.UNSAFE_REFERENCE
