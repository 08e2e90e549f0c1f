"""What a page must be for those who see little or nothing: axe-core finds nothing grave, in both schemes."""

from typing import Literal

from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page

SCHEMES: tuple[Literal["light", "dark"], ...] = ("light", "dark")
GRAVE = ("serious", "critical")


def assert_accessible(page: Page) -> None:
    """Look at the page as it is now; leave it in the light scheme."""
    for scheme in reversed(SCHEMES):
        page.emulate_media(color_scheme=scheme)
        violations = Axe().run(page).response["violations"]
        grave = [
            f"{scheme}: {found['id']}: {found['help']}: {[node['html'] for node in found['nodes']]}"
            for found in violations
            if found["impact"] in GRAVE
        ]
        assert not grave, "\n".join(grave)
