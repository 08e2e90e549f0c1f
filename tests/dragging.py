"""Files dragged from the desk into the browser, as the browser itself gets them: folders and all."""

from pathlib import Path

from playwright.sync_api import Page


def write(folder: Path, files: dict[str, bytes]) -> Path:
    """Write files below a folder; return it."""
    for name, content in files.items():
        place = folder / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(content)
    return folder


class Drag:
    """Files or folders held over a page.

    Parameters
    ----------
    page : Page
    paths : Path
        What is dragged.
    """

    def __init__(self, page: Page, *paths: Path) -> None:
        self._page = page
        self._data = {"items": [], "files": [str(path) for path in paths], "dragOperationsMask": 1}
        self._session = page.context.new_cdp_session(page)

    def over(self, x: float, y: float) -> None:
        """Hold them over a place of the window."""
        for kind in ("dragEnter", "dragOver"):
            self._send(kind, x, y)

    def drop(self, x: float, y: float) -> None:
        """Let go of them."""
        self.over(x, y)
        self._send("drop", x, y)
        self._session.detach()

    def drop_to_add(self) -> None:
        """Let go of them over the half that adds to the library."""
        self.drop(100, 300)

    def drop_to_find(self) -> None:
        """Let go of them over the half that finds what is similar."""
        self.drop(self._page.evaluate("innerWidth") - 100, 300)

    def _send(self, kind: str, x: float, y: float) -> None:
        event = {"type": kind, "x": x, "y": y, "data": self._data}
        self._session.send("Input.dispatchDragEvent", event)
