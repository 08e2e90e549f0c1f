"""Blocks of which one can say what differs, a library of them, and a browser that looks at it."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from playwright.sync_api import Browser, Page, Route, ViewportSize

from service.jobs.describing import describe_files
from tests.browsing import DESK, opened
from tests.serving import Serving, serving, settings_for
from tests.small_library import SIDES, open_small_library

HOSTILE = "<img src=x onerror=alert(1)> مزهرية"
CUBE, TOWER = (1.0, 1.0), (0.3, 3.0)  # width and height over depth
RED, BLUE = (210, 40, 30), (30, 60, 200)


def block(size: tuple[float, float], colour: tuple[int, int, int], seed: int = 0) -> dict[str, bytes]:
    """Return a block nearly of one colour."""
    width, height = size
    shades = np.clip(np.random.default_rng(seed).integers(-25, 25, (8, 3)) + colour, 0, 255)
    corners = [(x * width, y, z * height) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    header = ["ply", "format ascii 1.0", "element vertex 8", *(f"property float {axis}" for axis in "xyz")]
    header += [f"property uchar {name}" for name in ("red", "green", "blue")]
    header += ["element face 6", "property list uchar int vertex_indices", "end_header"]
    lines = [f"{x} {y} {z} {r} {g} {b}" for (x, y, z), (r, g, b) in zip(corners, shades, strict=True)]
    return {"block.ply": "\n".join([*header, *lines, *SIDES, ""]).encode()}


def add(service: Serving, files: dict[str, bytes], name: str) -> str:
    """Add a shape; return its id when it is ready."""
    added = service.add(files, name=name)
    assert added.status_code == 201, added.text
    return str(added.json()["id"])


@contextmanager
def blocks_served(folder: Path) -> Iterator[tuple[Serving, str]]:
    """Serve a red cube, a cube in blue, a tower in red and one in blue; give the first one's id, too."""
    with serving(settings_for(folder), describe=describe_files, open_library=open_small_library) as service:
        query = add(service, block(CUBE, RED), "red cube")
        add(service, block(CUBE, BLUE, 1), "blue cube")
        add(service, block(TOWER, RED, 2), "red tower")
        add(service, block(TOWER, BLUE, 3), HOSTILE)
        yield service, query


@contextmanager
def answer_of(
    service: Serving, address: str, browser: Browser, viewport: ViewportSize = DESK, **options: Any
) -> Iterator[Page]:
    """Open a view of the page."""
    with opened(browser, viewport, **options) as page:
        page.goto(f"{service.client.base_url}{address}")
        yield page


def names(page: Page) -> list[str]:
    """Return the results' names by rank."""
    return page.locator(".result .name").all_text_contents()


def answering(json: Any, status: int = 200) -> Callable[[Route], None]:
    """Return what answers a request in place of the service."""
    return lambda route: route.fulfill(status=status, json=json)
