"""`faience webhook`: who is told when a shape is ready or failed."""

from typing import Annotated

import typer

from service.commands.failures import plain_failures
from service.commands.options import DATA_DIR, DataDir, Json

webhook = typer.Typer(
    name="webhook",
    help="Tell other programs when a shape is ready or failed, by a signed POST to their address.",
    no_args_is_help=True,
)

Url = Annotated[str, typer.Argument(metavar="URL", help="Such as https://library.example/faience.")]
WebhookId = Annotated[str, typer.Argument(metavar="ID", help="As `faience webhook list` shows it.")]


@webhook.command("add")
def add(url: Url, data_dir: DataDir = DATA_DIR, json: Json = False) -> None:
    """Tell an address of every shape from now on, and show the secret that its messages are signed with."""
    with plain_failures():
        from service.commands.managing_webhooks import add_webhook  # heavy; --help must not wait for it

        add_webhook(url, data_dir, json)


@webhook.command("list")
def list_webhooks(data_dir: DataDir = DATA_DIR, json: Json = False) -> None:
    """Show who is told, and who could not be reached."""
    with plain_failures():
        from service.commands.managing_webhooks import show_webhooks  # heavy; --help must not wait for it

        show_webhooks(data_dir, json)


@webhook.command("test")
def try_one(webhook_id: WebhookId, data_dir: DataDir = DATA_DIR, json: Json = False) -> None:
    """Send a message of type `ping` now, and say what came of it."""
    with plain_failures():
        from service.commands.managing_webhooks import test_webhook  # heavy; --help must not wait for it

        test_webhook(webhook_id, data_dir, json)


@webhook.command("remove")
def remove(webhook_id: WebhookId, data_dir: DataDir = DATA_DIR, json: Json = False) -> None:
    """Tell an address nothing any more."""
    with plain_failures():
        from service.commands.managing_webhooks import remove_webhook  # heavy; --help must not wait for it

        remove_webhook(webhook_id, data_dir, json)
