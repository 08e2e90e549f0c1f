"""The page docs/errors.md, from the same table as the answers.

Made by ``python -m service.http.error_page > docs/errors.md``.
"""

import sys
from collections.abc import Iterator

from service.http.meanings import MEANINGS
from service.http.reasons import FAILURES, all_codes

HEAD = """\
# Errors

Every error is `application/problem+json` (RFC 9457). Its `code` is stable: programs may rely on it; `title`
and `detail` are for people. A shape whose status is `failed` has a code as well, in `error.code`.
"""
FAILED = """\
## Shapes that failed

What a mesh's headers tell is refused in the reply, with status 422. What only the worker finds turns the
shape to `failed`, with the same codes; sending the same files again tries again.
"""


def error_page() -> str:
    """Return the page."""
    return "\n".join([HEAD, FAILED, *_table(FAILURES), *_statuses()])


def _statuses() -> Iterator[str]:
    for status, codes in all_codes().items():
        yield f"## Status {status}\n"
        others = [code for code in codes if code not in FAILURES]
        if others != codes:
            yield "The codes above, and:\n"
        yield from _table(others)


def _table(codes: tuple[str, ...] | list[str]) -> Iterator[str]:
    yield "| code | what it means, and what to do |\n| --- | --- |"
    yield from (f"| `{code}` | {MEANINGS[code]} |" for code in codes)
    yield ""


if __name__ == "__main__":
    sys.stdout.write(error_page())
