"""A client that costs little: so many connections, each of which asks again as soon as it is answered."""

import asyncio
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

REQUEST = "GET {path} HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"


@dataclass(frozen=True, kw_only=True)
class Asked:
    """What came of some requests."""

    milliseconds: tuple[float, ...]  # of each answer
    seconds: float  # of all
    failures: int  # answers other than 200


def ask_all(port: int, paths: Sequence[str], clients: int, n_requests: int) -> Asked:
    """Ask for the paths in turn, ``n_requests`` times in all."""
    return asyncio.run(_ask_all(port, paths, clients, n_requests))


async def _ask_all(port: int, paths: Sequence[str], clients: int, n_requests: int) -> Asked:
    waiting = (paths[number % len(paths)] for number in range(n_requests))
    milliseconds: list[float] = []
    statuses: list[bytes] = []
    start = time.perf_counter()
    await asyncio.gather(*(_client(port, waiting, milliseconds, statuses) for _ in range(clients)))
    return Asked(
        milliseconds=tuple(milliseconds),
        seconds=time.perf_counter() - start,
        failures=sum(status != b"200" for status in statuses),
    )


async def _client(
    port: int, waiting: Iterator[str], milliseconds: list[float], statuses: list[bytes]
) -> None:
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    for path in waiting:
        start = time.perf_counter()
        writer.write(REQUEST.format(path=path).encode())
        head = await reader.readuntil(b"\r\n\r\n")
        await reader.readexactly(_length(head))
        milliseconds.append(1000.0 * (time.perf_counter() - start))
        statuses.append(head.split(None, 2)[1])
    writer.close()
    await writer.wait_closed()


def _length(head: bytes) -> int:
    for line in head.lower().split(b"\r\n"):
        if line.startswith(b"content-length:"):
            return int(line.partition(b":")[2])
    raise ValueError(f"an answer without a length: {head!r}")
