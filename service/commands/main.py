"""The `faience` command."""

import signal
import sys
from importlib.metadata import version
from typing import Annotated

import typer
from typer.exceptions import TyperException

from service.commands.compute import compute
from service.commands.duplicates import duplicates
from service.commands.evaluate import evaluate
from service.commands.export import export
from service.commands.failures import STOPPED, say
from service.commands.importing import import_file
from service.commands.index import index
from service.commands.key import key
from service.commands.search import search
from service.commands.serve import serve
from service.commands.vocabulary import learn_vocabulary
from service.commands.webhook import webhook
from service.commands.worker import worker

app = typer.Typer(
    name="faience",
    help="Find coloured 3D shapes that look alike, whatever their pose.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,  # a defect keeps its plain traceback, for a report
)
for command in (serve, worker, compute, index, search, duplicates, evaluate, export):
    app.command()(command)
app.command("import")(import_file)
app.command("learn-vocabulary")(learn_vocabulary)
app.add_typer(key)
app.add_typer(webhook)


def _show_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"faience {version('faience')}")
        raise typer.Exit


@app.callback()
def faience(
    _version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Find coloured 3D shapes that look alike, whatever their pose."""


def main() -> None:
    """Run the command line; a wrong option gets one plain line, too."""
    for stop in (signal.SIGINT, signal.SIGTERM):  # a shell's background jobs start with SIGINT ignored
        signal.signal(stop, signal.default_int_handler)  # stop as for Ctrl-C, jobs given back
    try:
        sys.exit(app(standalone_mode=False))
    except typer.Abort:
        sys.exit(STOPPED)
    except TyperException as error:
        if error.format_message():  # empty where help was printed instead
            say(f"{error.format_message()} (see `faience --help`)")
        sys.exit(error.exit_code)
