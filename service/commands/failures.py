"""What a user did wrong becomes one plain line and an exit code, never a traceback."""

import contextlib
from collections.abc import Iterator

import typer

STOPPED = 130  # exit code after Ctrl-C, as shells expect it


class CommandFailed(Exception):
    """A command cannot go on; the message is for the user."""

    def __init__(self, message: str, exit_code: int = 1) -> None:
        super().__init__(message)
        self.exit_code = exit_code


@contextlib.contextmanager
def plain_failures() -> Iterator[None]:
    """Turn what the user can do something about into one line on stderr; defects keep their traceback."""
    try:
        yield
    except CommandFailed as error:
        say(str(error))
        raise typer.Exit(error.exit_code) from None
    except KeyboardInterrupt:
        raise typer.Exit(STOPPED) from None
    except typer.Exit:
        raise
    except Exception as error:
        from service.commands.explaining import explain  # loads the parts whose errors it knows

        message = explain(error)
        if message is None:
            raise
        say(message)
        raise typer.Exit(1) from None


def say(message: str) -> None:
    """Write one line on stderr."""
    typer.echo(f"faience: {' '.join(message.split())}", err=True)
