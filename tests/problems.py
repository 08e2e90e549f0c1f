"""What an error must look like."""

import httpx


def problem(answer: httpx.Response, status: int, code: str) -> str:
    """Check that an answer is a problem of RFC 9457; return its detail."""
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    body = answer.json()
    assert set(body) >= {"type", "title", "status", "detail", "code"}
    assert (body["status"], body["code"]) == (status, code)
    assert body["type"] == f"urn:faience:problem:{code}"
    assert "Traceback" not in answer.text
    return str(body["detail"])
