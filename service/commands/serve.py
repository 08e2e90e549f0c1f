"""`faience serve`: the API, its page and a worker in one process tree."""

import contextlib
import socket
from typing import Annotated

import typer

from service.commands.failures import CommandFailed, plain_failures
from service.commands.options import DATA_DIR, DataDir, Json
from service.commands.reporting import reporter

Host = Annotated[str | None, typer.Option("--host", help="Address to listen on.", show_default="127.0.0.1")]
Port = Annotated[
    int | None, typer.Option("--port", min=0, max=65535, help="0 takes a free one.", show_default="8000")
]
Workers = Annotated[
    int | None,
    typer.Option(
        "--workers", min=0, help="Meshes described at the same time; 0: none here.", show_default="2"
    ),
]
Insecure = Annotated[bool, typer.Option("--insecure", help="Listen beyond this machine without a key.")]
Samples = Annotated[bool, typer.Option("--samples", help="Fill an empty library with sample creatures.")]


def serve(
    host: Host = None,
    port: Port = None,
    workers: Workers = None,
    insecure: Insecure = False,
    samples: Samples = False,
    data_dir: DataDir = DATA_DIR,
    json: Json = False,
) -> None:
    """Serve the library over HTTP until stopped."""
    with plain_failures():
        from service.commands.opening import opened, settings_for  # heavy; --help must not wait for it
        from service.commands.watching import watching
        from service.first_run import lacks_samples
        from service.listening import check_listening
        from service.samples import count_samples
        from service.server import run_server

        settings = settings_for(data_dir, host=host, port=port, workers=workers, insecure=insecure or None)
        check_listening(settings)
        check_address(settings.host, settings.port)
        with opened(settings, make=True) as library:  # what is wrong with it is said before anything starts
            new = lacks_samples(library, count_samples())
        show = samples and new and settings.workers > 0
        with watching(settings, "Samples", count_samples()) if show else contextlib.nullcontext():
            run_server(settings, settings.workers, samples, reporter(json))


def check_address(host: str, port: int) -> None:
    """Fail where nobody could listen there.

    Raises
    ------
    CommandFailed
        The port is in use, needs rights that the user lacks, or the address is not this machine's.
    """
    try:
        found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)[0]
        with contextlib.closing(socket.socket(found[0], found[1])) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind(found[4])
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise CommandFailed(
            f"cannot listen on {host}:{port}: {reason}; choose another --port or --host"
        ) from None
