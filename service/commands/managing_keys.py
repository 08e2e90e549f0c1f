"""What `faience key` does. It opens the database alone: a key must be had before the first start."""

import json
from datetime import datetime
from pathlib import Path

import typer
from rich.console import Console
from rich.table import Column, Table

from index.keys import ApiKey, Keys
from index.scopes import Scope
from service.commands.databases import opened_database

MAKER = "faience key create NAME"


def create_key(name: str, scope: Scope, data_dir: Path, as_json: bool) -> None:
    """Make a key, in a new library where there is none, and print it."""
    with opened_database(data_dir, maker=MAKER, make=True) as engine:
        key, secret = Keys(engine).create(name, scope)
    if as_json:
        typer.echo(json.dumps({**_fields(key), "key": secret}))
        return
    allowed = "look and search" if scope is Scope.READ else "look, search, add, change and remove"
    typer.echo(f"Key {key.id} of {key.name!r}, which may {allowed}:")
    typer.echo(f"\n    {secret}\n")
    typer.echo("Keep it now: it is not shown again. Clients send it as `Authorization: Bearer …`.")


def show_keys(data_dir: Path, as_json: bool) -> None:
    """Print every key, oldest first.

    Raises
    ------
    CommandFailed
        There is no library.
    """
    with opened_database(data_dir, maker=MAKER) as engine:
        known = Keys(engine).known()
    if as_json:
        for key in known:
            typer.echo(json.dumps(_fields(key)))
    elif known:
        Console().print(_table(known))
    else:
        typer.echo("There are no keys; `faience key create NAME` makes one.")


def revoke_key(key_id: str, data_dir: Path, as_json: bool) -> None:
    """Revoke a key and say what that means.

    Raises
    ------
    CommandFailed, KeyNotFound
        There is no library, or no such key.
    """
    with opened_database(data_dir, maker=MAKER) as engine:
        keys = Keys(engine)
        key, left = keys.revoke(key_id), len(keys.active())
    if as_json:
        typer.echo(json.dumps(_fields(key)))
        return
    typer.echo(f"Key {key.id} of {key.name!r} opens nothing any more.")
    if not left:
        typer.echo(
            "It was the last one: a service that runs now stays closed until there is another key, or until "
            "it is started again for this machine alone."
        )


def _fields(key: ApiKey) -> dict[str, str | None]:
    revoked = key.revoked_at.isoformat() if key.revoked_at else None
    return {
        "id": key.id,
        "name": key.name,
        "scope": str(key.scope),
        "created_at": key.created_at.isoformat(),
        "revoked_at": revoked,
    }


def _table(known: list[ApiKey]) -> Table:
    table = Table(Column("id", no_wrap=True), Column("name", overflow="fold"), "scope", "made", "revoked")
    for key in known:
        revoked = _day(key.revoked_at) if key.revoked_at else ""
        table.add_row(key.id, key.name.replace("[", r"\["), key.scope, _day(key.created_at), revoked)
    return table


def _day(moment: datetime) -> str:
    return moment.astimezone().strftime("%Y-%m-%d %H:%M")  # the reader's own clock
