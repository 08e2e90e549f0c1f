"""Text that users send in forms, queries and bodies, read strictly and with an answer that helps."""

import json
import re
from collections.abc import Mapping
from typing import Any, NoReturn

TRUE, FALSE = frozenset({"true", "1", "yes", "on"}), frozenset({"false", "0", "no", "off", ""})
NUL = re.compile(r"(?<!\\)(?:\\\\)*\\u0000")  # as JSON writes it, not a backslash before "u0000"
NAME_LENGTH = 500  # characters
DEPTH = 32  # of objects and lists inside metadata; some clients and our own answers bear little more


class BadField(ValueError):
    """A field does not hold what it should."""

    code = "bad_field"


class BadMetadata(BadField):
    """Metadata is not a JSON object, or holds what cannot be stored."""

    code = "bad_metadata"


class UnreadableWeights(BadField):
    """Weights are neither ``block:number,…`` nor a JSON object of numbers."""

    code = "bad_weights"


def read_flag(name: str, text: str) -> bool:
    """Return whether a flag is set; ``true``, ``1``, ``yes`` and ``on`` set it."""
    word = text.strip().lower()
    if word not in TRUE | FALSE:
        raise BadField(f"{name} is {text[:40]!r}; expected true or false")
    return word in TRUE


def check_name(name: str) -> str:
    """Return a shape's name without outer blanks; it must be printable, and 1 to 500 characters long."""
    plain = name.strip()
    if not plain or len(plain) > NAME_LENGTH or not plain.isprintable():
        raise BadField(f"a name has 1 to {NAME_LENGTH} printable characters, got {name[:40]!r}")
    return plain


def read_metadata(text: str) -> dict[str, Any]:
    """Return the metadata of a JSON text; see `check_metadata`."""
    return check_metadata(_json(text, BadMetadata))


def check_metadata(value: object) -> dict[str, Any]:
    """Return ``value`` if it is a JSON object that every database and client can hold."""
    if not isinstance(value, dict):
        raise BadMetadata(f"metadata is a JSON object, got {type(value).__name__}")
    try:
        text = json.dumps(value, ensure_ascii=False, allow_nan=False)
        text.encode()  # lone surrogates have no encoding
    except (ValueError, RecursionError) as error:
        raise BadMetadata(f"metadata cannot be stored: {error}") from error
    if NUL.search(text):
        raise BadMetadata("metadata holds a NUL character")
    if _depth(value) > DEPTH:
        raise BadMetadata(f"metadata is nested deeper than {DEPTH} levels")
    return value


def _depth(value: object) -> int:
    """Count the levels of objects and lists inside one another."""
    depth, level = 0, [value]
    while level := [each for each in level if isinstance(each, dict | list)]:
        depth += 1
        level = [inner for each in level for inner in (each.values() if isinstance(each, dict) else each)]
    return depth


def read_weights(text: str | None) -> dict[str, float] | None:
    """Return own weights from ``log-hks:1,colour-histogram:0.5`` or from a JSON object."""
    if not text:
        return None
    if text.lstrip().startswith("{"):
        pairs: Mapping[str, Any] = _json(text, UnreadableWeights)
    else:
        parts = [_pair(part) for part in text.split(",")]
        pairs = dict(parts)
        if len(pairs) < len(parts):
            raise UnreadableWeights("a block is named twice")
    return {block: _number(block, value) for block, value in pairs.items()}


def _pair(part: str) -> tuple[str, str]:
    block, colon, number = part.partition(":")
    if not colon:
        raise UnreadableWeights(f"expected block:number, got {part[:60]!r}")
    return block.strip(), number


def _number(block: str, value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError) as error:
        raise UnreadableWeights(f"the weight of {block[:60]!r} is not a number") from error


def _json(text: str, refusal: type[BadField]) -> Any:
    def refuse(word: str) -> NoReturn:
        raise refusal(f"{word} is not JSON")

    try:
        return json.loads(text, parse_constant=refuse)
    except (ValueError, RecursionError) as error:
        if isinstance(error, BadField):
            raise
        raise refusal(f"not readable as JSON: {error}") from error
