"""Lines for the user of a command that goes on running."""

import json
from collections.abc import Callable

import typer


def reporter(as_json: bool) -> Callable[[str], None]:
    """Return what prints a line, plain or as a JSON object with the key ``message``."""

    def report(line: str) -> None:
        typer.echo(json.dumps({"message": line}) if as_json else line)

    return report
