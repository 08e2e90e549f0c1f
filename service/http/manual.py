"""The manual of the interface as one plain HTML page, made from its OpenAPI description."""

from collections.abc import Iterator, Mapping
from html import escape
from typing import Any

Schema = Mapping[str, Any]

PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}: interface</title>
<link rel="icon" href="/static/icon.svg">
<link rel="stylesheet" href="/static/styles/base.css">
</head>
<body>
<header><a href="/">{title}</a> {version}</header>
<main class="manual">
<h1>{summary}</h1>
<p>{description}</p>
<p>For programs: <a href="/openapi.json">openapi.json</a></p>
{calls}
</main>
</body>
</html>
"""


def manual(interface: Schema) -> str:
    """Return the page.

    Parameters
    ----------
    interface : mapping
        OpenAPI 3.1, as ``app.openapi()`` returns it.
    """
    info = interface["info"]
    return PAGE.format(
        title=escape(info["title"]),
        version=escape(info["version"]),
        summary=escape(info.get("summary", "")),
        description=escape(info.get("description", "")),
        calls="\n".join(_calls(interface["paths"])),
    )


def _calls(paths: Schema) -> Iterator[str]:
    for path, methods in paths.items():
        for method, call in methods.items():
            yield _call(method.upper(), path, call)


def _call(method: str, path: str, call: Schema) -> str:
    name = escape(call["operationId"])
    head = f'<section id="{name}"><h2><code>{method} {escape(path)}</code></h2>'
    text = f"<p><b>{escape(call.get('summary', ''))}.</b> {escape(call.get('description', ''))}</p>"
    parameters = [_row(part["name"], part["in"], part, part["schema"]) for part in call.get("parameters", [])]
    fields = [_row(field, "body", schema, schema) for field, schema in _form(call).items()]
    answers = [
        f"<tr><td>{escape(str(status))}</td><td></td><td>{escape(answer['description'])}</td></tr>"
        for status, answer in call["responses"].items()
    ]
    return head + text + _table("Takes", parameters + fields) + _table("Answers", answers) + "</section>"


def _form(call: Schema) -> Schema:
    for content in call.get("requestBody", {}).get("content", {}).values():
        properties: Schema = content["schema"].get("properties", {})
        return properties
    return {}


def _row(name: str, place: str, described: Schema, schema: Schema) -> str:
    notes = [described.get("description", "")]
    if schema.get("default") is not None:
        notes.append(f"default: {schema['default']}")
    text = escape("; ".join(note for note in notes if note))
    return f"<tr><td><code>{escape(name)}</code></td><td>{escape(place)}</td><td>{text}</td></tr>"


def _table(title: str, rows: list[str]) -> str:
    if not rows:
        return ""
    return f"<h3>{title}</h3><table><tbody>{''.join(rows)}</tbody></table>"
