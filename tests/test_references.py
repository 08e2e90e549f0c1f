"""Names mean files of the upload, and nothing else."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from worker.errors import Code, MeshError
from worker.reading.references import SentFiles, normalise


def sent(*names: str) -> SentFiles:
    return SentFiles(dict.fromkeys(names, b""))


@pytest.mark.parametrize(
    ("reference", "named_by", "found"),
    [
        ("t.png", "m.mtl", "t.png"),
        ("./t.png", "m.mtl", "t.png"),
        (".\\T.PNG", "m.mtl", "t.png"),
        ("tex\\skin.png", "a/m.mtl", "a/tex/skin.png"),
        ("../b/wood.png", "a/m.mtl", "b/wood.png"),
        ("../../far/wood.png", "a/m.mtl", "b/wood.png"),
        ("/home/artist/wood.png", "a/m.mtl", "b/wood.png"),
        ("C:\\Users\\artist\\WOOD.png", "a/m.mtl", "b/wood.png"),
        ("cafe\u0301.png", "m.mtl", "caf\u00e9.png"),
    ],
)
def test_a_name_means_the_path_then_any_letter_case_then_the_only_base_name(
    reference: str, named_by: str, found: str
) -> None:
    files = sent("t.png", "a/tex/skin.png", "b/wood.png", "caf\u00e9.png")
    assert files.find(reference, named_by) == found


def test_a_name_that_could_mean_two_files_means_neither() -> None:
    assert sent("red/cube.mtl", "green/cube.mtl").find("cube.mtl", "cube.obj") is None


def test_the_exact_path_wins_over_the_same_base_name() -> None:
    assert sent("red/cube.mtl", "cube.mtl").find("cube.mtl", "cube.obj") == "cube.mtl"


def test_a_file_inside_that_was_not_sent_is_just_missing() -> None:
    assert sent("m.obj").find("textures/t.png", "m.obj") is None


@pytest.mark.parametrize(
    "reference",
    ["/etc/passwd", "../sibling.mtl", "../../../etc/passwd", "C:\\x.mtl", "\\\\server\\x.mtl", "/dev/zero"],
)
def test_a_name_outside_of_the_upload_is_refused(reference: str) -> None:
    with pytest.raises(MeshError) as caught:
        sent("m.obj").find(reference, "m.obj")
    assert caught.value.code == Code.UNSAFE_REFERENCE


@given(st.text(alphabet="a./\\: é\0", max_size=12))
def test_a_normalised_path_never_leaves_and_stays_as_it_is(path: str) -> None:
    normal = normalise(path)
    if normal is not None:
        assert not normal.startswith("/")
        assert ".." not in normal.split("/")
        assert normalise(normal) == normal
