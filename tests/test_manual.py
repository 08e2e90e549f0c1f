"""Text from the description cannot become markup."""

from service.http.manual import manual


def test_everything_is_escaped() -> None:
    call = {
        "operationId": "x",
        "summary": "<b>",
        "description": "a & b",
        "parameters": [{"name": "<i>", "in": "query", "description": "<u>", "schema": {"default": "<s>"}}],
        "responses": {"200": {"description": "<script>"}},
    }
    page = manual({"info": {"title": "<t>", "version": "1"}, "paths": {"/<p>": {"get": call}}})
    for mark in ("<b>Takes", "<i>", "<u>", "<s>", "<script>", "<t>", "<p>x"):
        assert mark not in page
    assert "GET /&lt;p&gt;" in page
    assert "default: &lt;s&gt;" in page
