"""What `faience webhook` does. It opens the database alone."""

import json
import secrets
from pathlib import Path

import httpx2
import typer
from rich.console import Console
from rich.table import Column, Table

from index.revisions import now
from index.webhooks import Webhook, Webhooks
from service.commands.databases import opened_database
from service.commands.failures import CommandFailed
from service.webhooks.sending import message, send
from service.webhooks.signing import shown

MAKER = "faience webhook add URL"


def add_webhook(url: str, data_dir: Path, as_json: bool) -> None:
    """Add a webhook and print its secret."""
    with opened_database(data_dir, maker=MAKER, make=True) as engine:
        hook, secret = Webhooks(engine).add(url)
    if as_json:
        typer.echo(json.dumps({**_fields(hook), "secret": shown(secret)}))
        return
    typer.echo(f"{hook.url} is told of every shape that becomes ready or fails; its id is {hook.id}.")
    typer.echo(f"\n    {shown(secret)}\n")
    typer.echo(
        "Messages are signed with this secret, as standardwebhooks.com describes; "
        "docs/webhooks.md shows how to check it."
    )


def show_webhooks(data_dir: Path, as_json: bool) -> None:
    """Print every webhook, oldest first."""
    with opened_database(data_dir, maker=MAKER) as engine:
        known = Webhooks(engine).known()
    if as_json:
        for hook in known:
            typer.echo(json.dumps(_fields(hook)))
    elif known:
        Console().print(_table(known))
    else:
        typer.echo("Nobody is told; `faience webhook add URL` changes that.")


def test_webhook(webhook_id: str, data_dir: Path, as_json: bool) -> None:
    """Send a message without a shape.

    Raises
    ------
    CommandFailed
        It did not arrive.
    """
    with opened_database(data_dir, maker=MAKER) as engine:
        url, secret = Webhooks(engine).address(webhook_id)
    with httpx2.Client(follow_redirects=False) as client:
        failure = send(client, url, secret, f"msg_ping_{secrets.token_hex(8)}", message("ping", now(), {}))
    if as_json:
        typer.echo(json.dumps({"url": url, "arrived": failure is None, "failure": failure}))
    elif failure is None:
        typer.echo(f"{url} took the message.")
    if failure is not None:
        raise CommandFailed(f"{url} did not take the message: {failure}")


def remove_webhook(webhook_id: str, data_dir: Path, as_json: bool) -> None:
    """Remove a webhook and what it was not told yet."""
    with opened_database(data_dir, maker=MAKER) as engine:
        Webhooks(engine).remove(webhook_id)
    typer.echo(
        json.dumps({"id": webhook_id}) if as_json else f"The webhook {webhook_id} is told nothing any more."
    )


def _fields(hook: Webhook) -> dict[str, str | int | None]:
    return {
        "id": hook.id,
        "url": hook.url,
        "created_at": hook.created_at.isoformat(),
        "failures": hook.failures,
        "failure": hook.failure,
    }


def _table(known: list[Webhook]) -> Table:
    table = Table(Column("id", no_wrap=True), Column("address", overflow="fold"), "not reached", "why")
    for hook in known:
        times = f"{hook.failures} times" if hook.failures else ""
        table.add_row(hook.id, hook.url.replace("[", r"\["), times, (hook.failure or "").replace("[", r"\["))
    return table
