"""One message to one address."""

import json
import time
from collections.abc import Mapping
from datetime import datetime
from typing import Any

import httpx2

from service.webhooks.signing import signature

PATIENCE = 10.0  # seconds for an answer
READ = 200  # bytes of an answer that may be told


def message(kind: str, happened_at: datetime, data: Mapping[str, Any]) -> bytes:
    """Return a message's body: ``type``, ``timestamp`` and ``data``, as Standard Webhooks recommends."""
    told = {"type": kind, "timestamp": happened_at.isoformat().replace("+00:00", "Z"), "data": dict(data)}
    return json.dumps(told).encode()


def send(client: httpx2.Client, url: str, secret: bytes, message_id: str, body: bytes) -> str | None:
    """Send a message; return why it did not arrive, in words, or None.

    Only an answer of 2xx counts as arrived; redirections are not followed.
    """
    moment = int(time.time())
    headers = {
        "content-type": "application/json",
        "user-agent": "faience",
        "webhook-id": message_id,
        "webhook-timestamp": str(moment),
        "webhook-signature": signature(secret, message_id, moment, body),
    }
    try:
        with client.stream("POST", url, content=body, headers=headers, timeout=PATIENCE) as answer:
            return None if answer.is_success else f"answered {answer.status_code}"
    except (httpx2.HTTPError, httpx2.InvalidURL, OSError) as error:
        return f"{type(error).__name__}: {error}"[:READ]
