"""The interface's own description: errors, forms and authorisation that FastAPI cannot infer."""

from http import HTTPStatus
from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi

from service.http.meanings import MEANINGS
from service.http.problems import MEDIA_TYPE
from service.http.reasons import EVERY, KEYS, Reason, all_codes, by_status
from service.http.schemas import ProblemModel
from service.intake.fields import FALSE, TRUE

SUMMARY = "Search engine for coloured 3D shapes"
DESCRIPTION = """\
Upload textured meshes (PLY; OBJ with MTL and images; or a zip of them), ask what looks like one of them.

Where the service has keys, send one as `Authorization: Bearer …`: a `read` key for whatever changes nothing,
a `write` key for everything. Each may send so many meshes a minute; `Retry-After` says when to go on.

Every answer has an `X-Request-ID`: yours, where it is up to 64 letters, digits, dots, dashes or underscores.
Errors are `application/problem+json` (RFC 9457) with a stable `code`. Times are RFC 3339.
Lists are `{"items": […], "next_cursor": …}`; give `next_cursor` back as `cursor` for the next page.
"""

FORM: dict[str, Any] = {
    "type": "object",
    "required": ["files"],
    "properties": {
        "files": {
            "type": "array",
            "minItems": 1,
            "items": {"type": "string", "format": "binary"},
            "description": "one mesh (.ply, or .obj with its .mtl and images), or one .zip; "
            "the parts' file names may be relative paths",
        }
    },
}
RETRY_AFTER = {
    "description": "seconds after which to try again",
    "required": True,
    "schema": {"type": "integer", "minimum": 1},
}
CHALLENGE = {"description": "how to send a key", "required": True, "schema": {"type": "string"}}
HEADERS: dict[int, dict[str, Any]] = {
    401: {"WWW-Authenticate": CHALLENGE},
    429: {"Retry-After": RETRY_AFTER},
    503: {"Retry-After": RETRY_AFTER},
}
DETAILS: dict[str, Any] = {
    "name": {"type": "string", "description": "default: the stem of the mesh file"},
    "metadata": {"type": "string", "description": "a JSON object", "examples": ['{"period": "archaic"}']},
    "allow_untextured": {
        "type": "string",
        "enum": sorted(TRUE | FALSE),
        "default": "false",
        "description": "accept a mesh whose MTL or images were not sent",
    },
}


def form_body(*, details: bool) -> dict[str, Any]:
    """Return the description of a multipart body; it is read while it arrives, not by FastAPI.

    Parameters
    ----------
    details : bool
        Whether name and metadata go with the files.
    """
    names = DETAILS if details else {"allow_untextured": DETAILS["allow_untextured"]}
    schema = {**FORM, "properties": {**FORM["properties"], **names}}
    return {"requestBody": {"required": True, "content": {"multipart/form-data": {"schema": schema}}}}


def problems(*reasons: Reason) -> dict[int | str, dict[str, Any]]:
    """Return the description of the errors that a call may answer, next to those of every call.

    Parameters
    ----------
    *reasons
        Families of `service.http.reasons`, unpacked.
    """
    return {status: _problem(status, codes) for status, codes in by_status((*EVERY, *reasons)).items()}


def _problem(status: int, codes: list[str]) -> dict[str, Any]:
    """Return the description of the problems with one status."""
    names = ", ".join(f"`{code}`" for code in codes)
    own = {"properties": {"status": {"const": status}, "code": {"enum": codes}}}
    schema = {"allOf": [{"$ref": "#/components/schemas/ProblemModel"}, own]}
    return {
        "description": f"{HTTPStatus(status).phrase}: {names}",
        "content": {MEDIA_TYPE: {"schema": schema}},
        **({"headers": HEADERS[status]} if status in HEADERS else {}),
    }


GUARDED = problems(*KEYS)  # of every call that asks for a key


def whole_binary(media_type: str, description: str) -> dict[int | str, dict[str, Any]]:
    """Return the description of an answer that is a file, made for this request."""
    content = {"schema": {"type": "string", "format": "binary"}}
    return {200: {"description": description, "content": {media_type: content}}}


def binary(media_type: str, description: str) -> dict[int | str, dict[str, Any]]:
    """Return the description of an answer that is a file, of which a part may be asked for."""
    content = {"schema": {"type": "string", "format": "binary"}}
    return {
        **whole_binary(media_type, description),
        206: {
            "description": f"{description}: the part that `Range` asks for",
            "content": {media_type: content, "multipart/byteranges": content},
        },
    }


def _all_codes() -> dict[str, Any]:
    """Return the description of the codes of all problems, with what each means."""
    codes = sorted({code for codes in all_codes().values() for code in codes})
    meanings = "\n".join(f"* `{code}`: {MEANINGS[code]}" for code in codes)
    return {"type": "string", "enum": codes, "description": f"stable; one of\n\n{meanings}"}


def describe_interface(app: FastAPI) -> None:
    """Let ``app.openapi()`` hold the error model too."""

    def openapi() -> dict[str, Any]:
        if app.openapi_schema is None:
            schema = get_openapi(
                title=app.title,
                version=app.version,
                summary=app.summary,
                description=app.description,
                routes=app.routes,
            )
            models = schema.setdefault("components", {}).setdefault("schemas", {})
            models["ProblemModel"] = ProblemModel.model_json_schema()
            models["ProblemModel"]["properties"]["code"] = _all_codes()
            app.openapi_schema = schema
        return app.openapi_schema

    app.openapi = openapi  # type: ignore[method-assign] # the way that FastAPI documents
