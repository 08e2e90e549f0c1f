"""What the tests of adding meshes share: textured meshes to send, and where their rows are."""

import io
import zipfile

from playwright.sync_api import Locator, Page

from tests.mesh_files import png

REFUSED = "status of 422"  # the browser's console notes every refusal
CORNERS = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
FACES = ("1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6")
UVS = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"


def textured(width: float, material: str = "clay", library: str = "vase.mtl") -> bytes:
    """Return an OBJ: a block of some width, that needs a material file and an image."""
    vertices = "".join(f"v {x * width} {y} {z}\n" for x, y, z in CORNERS)
    corners = (" ".join(f"{v}/{t}" for t, v in enumerate(face.split(), start=1)) for face in FACES)
    faces = "".join(f"f {face}\n" for face in corners)
    return f"mtllib {library}\n{vertices}{UVS}usemtl {material}\n{faces}".encode()


def vase(width: float) -> dict[str, bytes]:
    """Return a mesh with all that belongs to it."""
    return {
        "vase.obj": textured(width),
        "vase.mtl": b"newmtl clay\nmap_Kd clay.png\n",
        "clay.png": png(),
    }


def rows(page: Page) -> Locator:
    """Return the rows of all uploads."""
    return page.get_by_role("complementary", name="Meshes being added").locator(".upload")


def row(page: Page, name: str) -> Locator:
    """Return the row of an upload."""
    return rows(page).filter(has=page.get_by_text(name, exact=True))


def choose(page: Page, button: Locator, *files: str) -> None:
    """Choose files in the dialog that a button opens."""
    with page.expect_file_chooser() as chooser:
        button.click()
    chooser.value.set_files(list(files))


def zipped(files: dict[str, bytes]) -> bytes:
    """Return a zip of files."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return stream.getvalue()
