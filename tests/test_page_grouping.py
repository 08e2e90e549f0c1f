"""The page sends with a mesh what the service would read for it: both are asked, and compared."""

import base64
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from playwright.sync_api import Browser, Page

from service.commands.companions import Companions
from service.commands.discovery import find_sources
from tests.browsing import opened
from tests.dragging import write
from tests.mesh_files import TRIANGLE, png
from tests.serving import serving, settings_for
from worker.errors import MeshError
from worker.reading.limits import Limits
from worker.reading.mtl import read_map
from worker.reading.obj_scan import named_libraries
from worker.reading.references import SentFiles

FACE = "f 1/1 2/2 3/3\n"
BRICK, CLAY = b"newmtl brick\nmap_Kd brick.png\n", b"newmtl clay\nKd 1 0 0\nmap_Kd -bm 0.5 fired clay.png\n"
slow = settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=60)


@pytest.fixture(scope="module")
def page(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    with serving(settings_for(tmp_path_factory.mktemp("library"))) as service, opened(browser) as page:
        page.goto(str(service.client.base_url))
        yield page


def sent_by_page(page: Page, files: dict[str, bytes]) -> dict[str, set[str]]:
    """Return which files the page sends with each mesh, by the names that they are sent under."""
    packed = {name: base64.b64encode(content).decode() for name, content in files.items()}
    found: dict[str, list[str]] = page.evaluate(
        """async (packed) => {
          const { fromCommonFolder, meshesOf, poolOf, together } = await import("/static/adding/grouping.js");
          const bytes = (text) => Uint8Array.from(atob(text), (sign) => sign.charCodeAt(0));
          const sent = ([path, text]) => ({ path, file: new File([bytes(text)], "x") });
          const files = Object.entries(packed).map(sent);
          const found = {};
          for (const mesh of meshesOf(files)) {
            found[mesh.path] = fromCommonFolder(await together(mesh, poolOf(files))).map(({ path }) => path);
          }
          return found;
        }""",
        packed,
    )
    return {mesh: set(names) for mesh, names in found.items()}


def sent_by_command(folder: Path, files: dict[str, bytes]) -> dict[str, set[str]]:
    """Return the same of `faience index`."""
    (source,) = find_sources([write(folder, files)])
    companions = Companions(source, Limits())
    return {mesh.place: set(companions.files_of(mesh)) for mesh in source.meshes}


def obj(*lines: str) -> bytes:
    return ("\n".join(lines[:-1]) + "\n" + TRIANGLE + lines[-1] + "\n").encode()


CASES: dict[str, dict[str, bytes]] = {
    "one beside the other": {
        "in/vase.obj": obj("mtllib vase.mtl", f"usemtl brick\n{FACE}"),
        "in/vase.mtl": BRICK,
        "in/brick.png": png(),
        "in/other.png": png(),
    },
    "three share a material file, each needs its own image": {
        "a.obj": obj("mtllib all.mtl", f"usemtl brick\n{FACE}"),
        "b.obj": obj("mtllib all.mtl", f"usemtl clay\n{FACE}"),
        "c.obj": obj("mtllib all.mtl", f"usemtl clay\n{FACE}usemtl brick\n{FACE}"),
        "all.mtl": BRICK + CLAY,
        "brick.png": png(),
        "fired clay.png": png(),
    },
    "other folders, letter cases and separators": {
        "models/a/vase.obj": obj("mtllib ..\\Materials\\VASE.MTL", f"usemtl brick\n{FACE}"),
        "models/materials/vase.mtl": b"newmtl brick\nmap_Kd C:\\work\\Brick.PNG\n",
        "models/textures/brick.png": png(),
    },
    "a base name that two files have means neither": {
        "m/vase.obj": obj("mtllib vase.mtl", f"usemtl brick\n{FACE}"),
        "m/vase.mtl": BRICK,
        "x/brick.png": png(),
        "y/brick.png": png(),
    },
    "a name with blanks, and several names": {
        "one.obj": obj("mtllib my red vase.mtl", f"usemtl brick\n{FACE}"),
        "two.obj": obj("mtllib a.mtl b.mtl", f"usemtl clay\n{FACE}"),
        "my red vase.mtl": BRICK,
        "a.mtl": BRICK,
        "b.mtl": CLAY,
        "brick.png": png(),
        "fired clay.png": png(),
    },
    "material files are named at the end, and for themselves": {
        "late.obj": (TRIANGLE + f"usemtl brick\n{FACE}mtllib vase.mtl").encode(),
        "crlf.obj": obj("mtllib vase.mtl", f"usemtl brick\n{FACE}").replace(b"\n", b"\r\n"),
        "comment.obj": obj("# mtllib vase.mtl", f"usemtl brick\n{FACE}"),
        "vase.mtl": BRICK,
        "brick.png": png(),
    },
    "the first of two materials with one name counts": {
        "vase.obj": obj("mtllib vase.mtl", f"usemtl brick\n{FACE}"),
        "vase.mtl": BRICK + b"newmtl brick\nmap_Kd other.png\n",
        "brick.png": png(),
        "other.png": png(),
    },
    "accents composed or not": {
        "vase.obj": obj("mtllib e\u0301te\u0301.mtl", f"usemtl brick\n{FACE}"),
        "\u00e9t\u00e9.mtl": BRICK,
        "brick.png": png(),
    },
}


@pytest.mark.parametrize("case", CASES)
def test_the_same_files_go_with_a_mesh_as_the_command_line_sends(
    page: Page, tmp_path: Path, case: str
) -> None:
    assert sent_by_page(page, CASES[case]) == sent_by_command(tmp_path, CASES[case])


def test_a_ply_brings_the_images_that_its_header_names(page: Page) -> None:
    header = b"ply\nformat ascii 1.0\ncomment TextureFile my clay.png\nelement vertex 1\nend_header\n"
    ply = header + b"comment TextureFile b.png\n"
    files = {"in/vase.ply": ply, "in/my clay.png": png(), "in/b.png": png()}
    assert sent_by_page(page, files) == {"in/vase.ply": {"vase.ply", "my clay.png"}}


def test_a_zip_goes_alone(page: Page) -> None:
    assert sent_by_page(page, {"a/vase.zip": b"PK", "a/brick.png": png()}) == {"a/vase.zip": {"vase.zip"}}


def test_names_are_found_across_the_pieces_of_a_long_file(page: Page) -> None:
    text = "# a comment that fills the file up, line by line\n" * 8 + "mtllib m.mtl\nusemtl deep mtl\n"
    found = page.evaluate(
        """async (text) => {
          const { scanObj } = await import("/static/adding/scanning.js");
          const times = 20000; // more than two pieces
          const { libraries, materials } = await scanObj(new Blob(Array(times).fill(text)));
          return [libraries.length === times, [...new Set(libraries)], [...materials]];
        }""",
        text,
    )
    assert found == [True, ["m.mtl"], ["deep mtl"]]


def test_a_piece_that_begins_within_a_line_does_not_begin_one(page: Page) -> None:
    script = """async () => {
      const { scanObj } = await import("/static/adding/scanning.js");
      const comment = "#".padEnd(8 * 2 ** 20 - 1, "x"); // the next piece begins with the blank
      return (await scanObj(new Blob([comment, " mtllib no.mtl\\nmtllib yes.mtl"]))).libraries;
    }"""
    assert page.evaluate(script) == ["yes.mtl"]


@slow
@given(
    rest=st.lists(
        st.sampled_from(["-bm", "0.5", "-o", "1", "-S", "-clamp", "on", "a.png", "my", '"x y.png"', "\t"]),
        min_size=1,
    )
)
def test_options_before_and_after_a_name_are_read_as_the_service_reads_them(
    page: Page, rest: list[str]
) -> None:
    text = " ".join(rest).strip()
    if not text:
        return
    expected = read_map(text, "m.mtl")
    script = 'async (text) => (await import("/static/adding/materials.js")).imageOf(text)'
    assert page.evaluate(script, text) == (expected.reference if expected else "")


PARTS = st.lists(st.sampled_from(["a", "A", "b", "..", ".", "é", "c.png", "C.PNG"]), min_size=1, max_size=4)


@slow
@given(
    names=st.sets(PARTS.map("/".join), max_size=5),
    reference=PARTS.map("/".join),
    namer=st.sampled_from(["m.obj", "a/m.obj", "a/b/m.obj"]),
)
def test_names_find_the_files_that_the_service_would_find(
    page: Page, names: set[str], reference: str, namer: str
) -> None:
    plain = [name for name in names if not {"..", "."} & set(name.split("/"))]
    try:
        expected = SentFiles(dict.fromkeys(plain, b"")).find(reference, namer)
    except MeshError:
        expected = None
    script = """async ([names, reference, namer]) => {
      const { Pool } = await import("/static/adding/pool.js");
      return new Pool(names.map((path) => ({ path }))).find(reference, namer)?.path ?? null;
    }"""
    assert page.evaluate(script, [plain, reference, namer]) == expected


@slow
@given(
    lines=st.lists(
        st.sampled_from(
            [
                "mtllib a.mtl",
                " mtllib b c.mtl ",
                "mtllib",
                "xmtllib d.mtl",
                "# mtllib e",
                "mtllibx f",
                "v 0 0 mtllib",
                "\tmtllib\tg",
            ]
        )
    )
)
def test_lines_that_name_material_files_are_told_from_others(page: Page, lines: list[str]) -> None:
    text = "\n".join(lines)
    script = """async (text) => {
      const { scanObj } = await import("/static/adding/scanning.js");
      return (await scanObj(new Blob([text]))).libraries;
    }"""
    assert page.evaluate(script, text) == named_libraries((text + "\n").encode())
