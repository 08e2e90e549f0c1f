"""The pictures of a report: each is made small and embedded once, however often it is shown."""

import base64
import io
from collections.abc import Mapping
from html import escape

from PIL import Image

SIDE = 128  # pixels; shown at about 90, so that fine screens have some to spare
QUALITY = 80  # of WebP: a picture takes about 4 kB


class Album:
    """Shows pictures by name, and remembers which.

    Parameters
    ----------
    pictures : mapping
        Name → PNG. A name without one is shown as an empty frame.
    """

    def __init__(self, pictures: Mapping[str, bytes]) -> None:
        self._pictures = pictures
        self._ids: dict[bytes, str] = {}  # PNG → id, in the order of first use

    def show(self, name: str) -> str:
        """Return the HTML that shows a picture."""
        png = self._pictures.get(name)
        label = escape(name)
        if png is None:
            return f'<svg class="picture" viewBox="0 0 {SIDE} {SIDE}" role="img" aria-label="{label}"></svg>'
        number = self._ids.setdefault(png, f"p{len(self._ids)}")
        return (
            f'<svg class="picture" viewBox="0 0 {SIDE} {SIDE}" role="img" aria-label="{label}">'
            f'<use href="#{number}"/></svg>'
        )

    def definitions(self) -> str:
        """Return the HTML that holds every picture shown so far, once; it belongs on the same page."""
        size = f'width="{SIDE}" height="{SIDE}"'
        images = "\n".join(
            f'<image id="{number}" {size} href="data:image/webp;base64,{_small(png)}"/>'
            for png, number in self._ids.items()
        )
        return f'<svg width="0" height="0" aria-hidden="true" class="album"><defs>\n{images}\n</defs></svg>'


def _small(png: bytes) -> str:
    """Return a picture as WebP of at most SIDE² pixels, in base64."""
    image = Image.open(io.BytesIO(png)).convert("RGBA")
    image.thumbnail((SIDE, SIDE), Image.Resampling.LANCZOS)
    content = io.BytesIO()
    image.save(content, "WEBP", quality=QUALITY)
    return base64.b64encode(content.getvalue()).decode()
