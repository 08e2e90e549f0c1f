"""The parts of the soak: each breaks one thing on purpose and tells what came of it."""

import contextlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import httpx

from soak import crashes, fuzz, locked, small_disk
from soak.contract import check_contract
from soak.crowd import concurrent_uploads
from soak.cut import cut_uploads, last_cut, seams
from soak.parcels import TEXTURED, kind_of, parcel
from soak.processes import ending, free_port, serve, start, wait_until
from soak.stalled import RELEASE_SECONDS, stalled_clients
from soak.target import Target
from soak.target import form as form_of
from soak.wire import Address

Report = Callable[[str], None]  # takes a line for whoever waits
KEY = "a-key-of-the-soak"
ENVIRONMENT = {
    "FAIENCE_API_KEYS": KEY,
    "FAIENCE_UPLOADS_PER_MINUTE": "0",
    "FAIENCE_POLL_SECONDS": "0.1",
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
}
NAMED = {"api": "the API", "worker": "the worker", "child": "a child"}
WHOLE = [number for number in range(1, 20) if kind_of(number) != "empty"][:10]


@dataclass(frozen=True, kw_only=True)
class Order:
    """What a part is told."""

    folder: Path  # empty, for the part alone
    seed: int
    scale: float  # 1: the whole soak; less for a try
    meshes: Path | None  # folders of meshes to be mutated beside those made in code
    report: Report

    def many(self, count: int) -> int:
        """Return how many of something, at this scale, at least one."""
        return max(round(self.scale * count), 1)


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What came of a part."""

    figures: str  # a sentence for the page
    broken: tuple[str, ...] = ()  # promises; none is right


def mutants(order: Order) -> Outcome:
    """Give damaged files to the readers."""
    folders = sorted(path for path in order.meshes.iterdir() if path.is_dir()) if order.meshes else []
    result = fuzz.run(order.many(50_000), order.seed, folders=folders, report=order.report)
    slowest = f", the slowest took {result.slowest.cpu:.1f} s" if result.slowest else ""
    figures = (
        f"{result.mutants} mutants: {sum(result.refused.values())} refused with {len(result.refused)} codes, "
        f"{result.accepted} accepted as sound meshes{slowest}"
    )
    return Outcome(figures=figures, broken=tuple(failure.failure for failure in result.failures))


def kills(order: Order) -> Outcome:
    """Kill the service again and again."""
    found = crashes.run(order.folder, order.many(100), order.seed, lambda done: order.report(f"{done} kills"))
    targets = ", ".join(f"{found.harm[target]} of {NAMED[target]}" for target in crashes.TARGETS)
    figures = (
        f"{crashes.kills_of(found.harm)} kills ({targets}), {found.harm['damaged']} index files damaged, "
        f"{found.harm['paused']} workers put to sleep; {found.acknowledged} uploads acknowledged, "
        f"{found.removed} removals, {found.answers.total()} requests"
    )
    return Outcome(figures=figures, broken=tuple(found.broken))


def cuts(order: Order) -> Outcome:
    """Cut an upload at every byte, in three ways."""
    body = form_of(parcel(TEXTURED))
    every = max(round(1 / order.scale), 1)  # bytes from one cut to the next
    offsets = sorted({*seams(body), *range(0, last_cut(body) + 1, every)})
    with _target(order) as target:
        found = cut_uploads(target, body, offsets)
    return Outcome(
        figures=f"{found.cuts} cuts: nothing left, nothing kept; {found.again} whole ones between them kept"
    )


def stalls(order: Order) -> Outcome:
    """Stall clients beside one that works."""
    with _target(order) as target:
        found = stalled_clients(target, 20, requests=20, release_seconds=RELEASE_SECONDS)
    stalled, released = sum(found.stalled.values()), sum(found.released.values())
    broken = (f"only {released} of {stalled} stalled clients were let go of",) if released < stalled else ()
    return Outcome(
        figures=f"{stalled} clients stalled in {len(found.stalled)} places and were let go of; a request "
        f"beside them took {found.ratio:.1f} times as long as without",
        broken=broken,
    )


def crowd(order: Order) -> Outcome:
    """Send many uploads at once."""
    with _target(order) as target:
        found = concurrent_uploads(target, order.many(200), copies=4)
    answers = ", ".join(f"{status}: {count}" for status, count in sorted(found.answers.items()))
    return Outcome(
        figures=f"{found.sent} uploads at once of {found.contents} contents in {found.seconds:.0f} s, "
        f"one shape each ({answers})"
    )


def full_disk(order: Order) -> Outcome:
    """Fill the disk under the service."""
    try:
        with small_disk.small_disk(order.folder / "disk") as disk:
            found = small_disk.run(disk)
    except small_disk.NoSmallDisk as error:
        return Outcome(figures=f"not tried: {error}")
    told = {"upload": 507, "upload after a removal": 507, "remove": 204}
    wrong = [
        f"{call} on a full disk was answered with {status}"
        for statuses in (found.full, found.restarted)
        for call, status in statuses.items()
        if status != told.get(call, 200)
    ]
    wrong += [f"{name} is {state}" for name, state in found.states.items() if state != "ready"]
    return Outcome(
        figures="uploads 507, reads 200, removals 204, also after a restart on the full disk; an upload was "
        f"accepted {found.seconds_to_recover:.2f} s after there was room, and no job was lost",
        broken=tuple(wrong),
    )


def lock(order: Order) -> Outcome:
    """Lock the catalogue under the service."""
    found = locked.run(order.folder)
    broken = [f"a read was answered with {status}" for status in found.reads if status != httpx.codes.OK]
    broken += [f"an upload was answered with {status}" for status in found.uploads if status != 503]
    broken += [f"afterwards an upload was answered with {found.afterwards}"] * (found.afterwards != 202)
    return Outcome(
        figures=f"{found.uploads.total()} uploads told to come back (503), {found.reads.total()} reads "
        f"beside them, the slowest in {found.slowest_read:.2f} s",
        broken=tuple(broken),
    )


def contract(order: Order) -> Outcome:
    """Send what the service's own description suggests."""
    with _target(order) as target:
        url = f"http://{target.address.host}:{target.address.port}"
        found = check_contract(url, KEY, examples=order.many(300), seed=order.seed)
    return Outcome(
        figures=f"{found.requests} requests to {len(found.answers)} calls, answered as described",
        broken=tuple(f"{what} ({count} times)" for what, count in found.failures.items()),
    )


@contextlib.contextmanager
def _target(order: Order) -> Iterator[Target]:
    """Run a service with a key and a page of ready shapes."""
    port, folder = free_port(), order.folder / "library"
    service = serve(folder, port, 1, ENVIRONMENT)
    target = Target(address=Address(host="127.0.0.1", port=port), folder=folder, key=KEY)
    with ending(service):
        start(service, port)
        for number in WHOLE:
            assert target.upload(form_of(parcel(number))).status == httpx.codes.ACCEPTED
        wait_until(lambda: all(shape["status"] == "ready" for shape in target.shapes()), "the first shapes")
        yield target
        service.stop()


PARTS: Mapping[str, Callable[[Order], Outcome]] = {
    part.__name__: part for part in (mutants, kills, cuts, stalls, crowd, full_disk, lock, contract)
}
