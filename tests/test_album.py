import base64
import io
import re

import pytest
from PIL import Image

from service.evaluation.album import SIDE, Album


def png(colour: tuple[int, int, int, int], side: int = 256) -> bytes:
    content = io.BytesIO()
    Image.new("RGBA", (side, side), colour).save(content, "PNG")
    return content.getvalue()


def test_a_picture_is_embedded_once_however_often_it_is_shown() -> None:
    red, blue = png((255, 0, 0, 255)), png((0, 0, 255, 255))
    album = Album({"one": red, "two": blue, "same as one": red})
    shown = [album.show(name) for name in ("one", "two", "one", "same as one")]
    references = re.findall(r'href="#(\w+)"', "".join(shown))
    assert references == ["p0", "p1", "p0", "p0"]
    assert re.findall(r'<image id="(\w+)"', album.definitions()) == ["p0", "p1"]


def test_only_what_is_shown_is_embedded() -> None:
    album = Album({"one": png((255, 0, 0, 255))})
    assert "<image" not in album.definitions()


@pytest.mark.parametrize("side", [64, 256])
def test_pictures_are_small_and_keep_their_transparent_ground(side: int) -> None:
    album = Album({"one": png((255, 0, 0, 0), side)})
    album.show("one")
    encoded = re.search(r"data:image/webp;base64,([^\"]+)", album.definitions())
    assert encoded is not None
    image = Image.open(io.BytesIO(base64.b64decode(encoded[1])))
    assert image.size == (min(side, SIDE), min(side, SIDE))
    assert image.convert("RGBA").getpixel((0, 0))[3:] == (0,)  # type: ignore[index] # of four bands


def test_a_name_without_a_picture_is_an_empty_frame() -> None:
    shown = Album({}).show('a "name"')
    assert 'aria-label="a &quot;name&quot;"' in shown
    assert "<use" not in shown
