"""What the page asks for and this version of the service does not count yet: counts and tags, from the list of shapes."""

from collections import Counter
from typing import Any
from urllib.parse import parse_qs, urlsplit

from playwright.sync_api import Page, Route

from tests.serving import Serving

STATES = ("queued", "processing", "ready", "failed")


def count_for(page: Page, service: Serving) -> None:
    """Answer the two calls."""

    def listed(q: str = "") -> list[dict[str, Any]]:
        items: list[dict[str, Any]] = service.client.get("/v1/shapes", params={"limit": 500, "q": q}).json()[
            "items"
        ]
        return items

    def counts(route: Route) -> None:
        asked = parse_qs(urlsplit(route.request.url).query)
        found = [
            shape
            for shape in listed(asked.get("q", [""])[0])
            if set(asked.get("tag", [])) <= set(shape["metadata"].get("tags", []))
        ]
        split = Counter(shape["status"] for shape in found)
        route.fulfill(json={"total": len(found), **{state: split[state] for state in STATES}})

    def tags(route: Route) -> None:
        found = Counter(tag for shape in listed() for tag in shape["metadata"].get("tags", []))
        limit = int(parse_qs(urlsplit(route.request.url).query)["limit"][0])
        items = [{"tag": tag, "shapes": number} for tag, number in found.most_common(limit)]
        route.fulfill(json={"items": items, "next_cursor": "more" if len(found) > limit else None})

    if service.client.get("/v1/counts").status_code == 404:
        page.route("**/v1/counts*", counts)
        page.route("**/v1/tags*", tags)
