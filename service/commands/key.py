"""`faience key`: who may use the library over HTTP."""

from typing import Annotated

import typer

from index.scopes import Scope
from service.commands.failures import plain_failures
from service.commands.options import DATA_DIR, DataDir, Json

key = typer.Typer(
    name="key",
    help="Make, list and revoke the keys that programs send. A running service notices within a second.",
    no_args_is_help=True,
)

Name = Annotated[str, typer.Argument(metavar="NAME", help="Whose key it is, such as 'loan desk'.")]
KeyId = Annotated[str, typer.Argument(metavar="ID", help="As `faience key list` shows it.")]
Allowed = Annotated[
    Scope, typer.Option("--scope", help="read: look and search. write: also add, change and remove shapes.")
]


@key.command("create")
def create(name: Name, scope: Allowed = Scope.READ, data_dir: DataDir = DATA_DIR, json: Json = False) -> None:
    """Make a key and show it, this once. The library keeps only what recognises it."""
    with plain_failures():
        from service.commands.managing_keys import create_key  # heavy; --help must not wait for it

        create_key(name, scope, data_dir, json)


@key.command("list")
def list_keys(data_dir: DataDir = DATA_DIR, json: Json = False) -> None:
    """Show every key that was made, without its secret part."""
    with plain_failures():
        from service.commands.managing_keys import show_keys  # heavy; --help must not wait for it

        show_keys(data_dir, json)


@key.command("revoke")
def revoke(key_id: KeyId, data_dir: DataDir = DATA_DIR, json: Json = False) -> None:
    """Let a key open no more, for good."""
    with plain_failures():
        from service.commands.managing_keys import revoke_key  # heavy; --help must not wait for it

        revoke_key(key_id, data_dir, json)
