"""What the page asks for and this version of the service does not know yet: counts and tags, from the list of shapes."""

import re
from collections import Counter
from typing import Any
from urllib.parse import parse_qs, urlsplit

from playwright.sync_api import Page, Route

from tests.serving import Serving

STATES = ("queued", "processing", "ready", "failed")


def count_for(page: Page, service: Serving) -> None:
    """Answer the calls that know tags, and the one that counts."""

    def listed(q: str = "") -> list[dict[str, Any]]:
        items: list[dict[str, Any]] = service.client.get("/v1/shapes", params={"limit": 500, "q": q}).json()[
            "items"
        ]
        return items

    def tagged(tags: list[str], shapes: list[dict[str, Any]]) -> list[dict[str, Any]]:
        return [shape for shape in shapes if set(tags) <= set(shape["metadata"].get("tags", []))]

    def shapes(route: Route) -> None:
        asked = urlsplit(route.request.url)
        answer = service.client.get(f"{asked.path}?{asked.query}").json()
        items = tagged(parse_qs(asked.query)["tag"], answer["items"])
        route.fulfill(json={**answer, "items": items})

    def counts(route: Route) -> None:
        asked = parse_qs(urlsplit(route.request.url).query)
        found = tagged(asked.get("tag", []), listed(asked.get("q", [""])[0]))
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
        page.route(re.compile(r"/v1/shapes\?.*tag="), shapes)
