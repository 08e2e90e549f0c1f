"""A picture made smaller, so that no page loads one wider than it shows."""

import io

from PIL import Image


def smaller(png: bytes, width: int) -> bytes:
    """Return a square PNG with a transparent background in another width.

    Parameters
    ----------
    png : bytes
    width : int
        In pixels; a picture that is no wider comes back as it is.

    Returns
    -------
    bytes
        A PNG with premultiplied averages: no dark rim where the background begins.
    """
    picture = Image.open(io.BytesIO(png))
    if width >= picture.width:
        return png
    height = max(round(picture.height * width / picture.width), 1)
    # averages of colours count by opacity: what is transparent is black underneath
    small = picture.convert("RGBa").resize((width, height), Image.Resampling.LANCZOS).convert("RGBA")
    file = io.BytesIO()
    small.save(file, "PNG", compress_level=3)  # a fifth more bytes, half of the time
    return file.getvalue()
