"""What was sent has one hash, one name and safe file names."""

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.intake.submissions import ReceivedFile, Submission, receive_paths, safe_name
from worker.errors import MeshError


def received(name: str, digest: str = "00") -> ReceivedFile:
    return ReceivedFile(name=name, path=Path("unused"), size=0, sha256=digest)


def submission(*names: str) -> Submission:
    return Submission(files=tuple(received(name, f"{i:02x}") for i, name in enumerate(names)))


@given(st.permutations(["a.obj", "a.mtl", "b.png"]))
def test_the_order_of_files_does_not_change_the_content(order: list[str]) -> None:
    files = {name: received(name, f"hash of {name}") for name in order}
    plain = Submission(files=tuple(files[name] for name in sorted(order)))
    assert Submission(files=tuple(files.values())).content_hash() == plain.content_hash()


def test_names_contents_and_the_flag_change_the_content_but_name_and_metadata_do_not() -> None:
    plain = submission("a.obj", "b.png")
    others = [
        submission("a.obj", "c.png"),
        submission("b.png", "in/a.obj"),
        submission("a.obj"),
        replace(plain, allow_untextured=True),
    ]
    assert len({each.content_hash() for each in [plain, *others]}) == 5
    assert replace(plain, name="x", metadata={"y": 1}).content_hash() == plain.content_hash()


def test_a_renamed_mesh_is_the_same_content() -> None:
    first = Submission(files=(received("a.ply", "same"),))
    again = Submission(files=(received("Copy of a.PLY", "same"),))
    assert first.content_hash() == again.content_hash()
    assert Submission(files=(received("a.obj", "same"),)).content_hash() != first.content_hash()


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (("tex.png", "mesh/Krug.v2.OBJ", "m.mtl"), "Krug.v2"),
        (("parcel.zip",), "parcel"),
        (("notes.txt",), "notes"),
    ],
)
def test_the_name_is_the_stem_of_the_mesh(names: tuple[str, ...], expected: str) -> None:
    assert submission(*names).display_name() == expected
    assert replace(submission(*names), name="given").display_name() == "given"


def test_files_of_this_machine_are_hashed(tmp_path: Path) -> None:
    path = tmp_path / "f"
    path.write_bytes(b"abc")
    (file,) = receive_paths({"d/a.ply": path}).files
    assert (file.name, file.size) == ("d/a.ply", 3)
    assert file.sha256 == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"


@pytest.mark.parametrize(
    "name",
    [
        "",
        ".",
        "/a",
        "a/../b",
        "..",
        "..\\a",
        "\\\\host\\a",
        "C:\\a",
        "c:a",
        "a\0b",
        "a\nb",
        "\ud800",
        "x" * 1001,
    ],
)
def test_a_name_that_is_no_plain_relative_path_is_refused(name: str) -> None:
    with pytest.raises(MeshError, match="unsafe_reference"):
        safe_name(name)


def test_a_plain_name_is_kept_with_forward_slashes() -> None:
    assert safe_name("a\\b//./Größe 1.png") == "a/b/Größe 1.png"


@given(st.text(max_size=30))
def test_whatever_comes_out_stays_inside_a_folder(name: str) -> None:
    try:
        plain = safe_name(name)
    except MeshError:
        return
    folder = Path("/folder")
    assert folder in (folder / plain).parents
    assert safe_name(plain) == plain
