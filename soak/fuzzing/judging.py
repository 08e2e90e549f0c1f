"""One mutant before the readers: what came of it, or which promise was broken."""

import hashlib
import traceback
from collections.abc import Callable
from dataclasses import dataclass

from service.jobs.rehearsal import SMALL
from soak.fuzzing.mutating import Mutant
from soak.fuzzing.promises import (
    Broken,
    check_description,
    check_mesh,
    check_refusal,
    check_repaired,
)
from worker.describe import describe
from worker.errors import MeshError
from worker.geometry.repair import Repaired, repair
from worker.reading.mesh import Mesh
from worker.reading.upload import Upload, inspect_upload, read_mesh

ACCEPTED = "accepted"
Reader = Callable[[Upload], Mesh]


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """What came of one mutant."""

    outcome: str  # ACCEPTED or a code of `worker.errors.Code`
    failure: str = ""  # which promise was broken, or nothing


def judge(mutant: Mutant, reader: Reader = read_mesh, *, again: bool = False, whole: bool = False) -> Verdict:
    """Read a mutant and hold what comes against the promises.

    Parameters
    ----------
    mutant : Mutant
    reader : callable
        As `read_mesh`; another one shows that failures are noticed.
    again : bool
        Read it twice and compare.
    whole : bool
        Describe it too, in small, where it is accepted.
    """
    upload = Upload(files=mutant.files, allow_untextured=mutant.allow_untextured)
    try:
        outcome, print_ = _read(upload, reader)
        if again and _read(upload, reader) != (outcome, print_):
            raise Broken("the same bytes have two outcomes")
        _inspect(upload, accepted=outcome == ACCEPTED)
        if whole and outcome == ACCEPTED:
            outcome = _described(upload)
    except Broken as broken:
        return Verdict(outcome="broken", failure=str(broken))
    except Exception:  # noqa: BLE001 - whatever is raised but a refusal is what is looked for
        return Verdict(outcome="raised", failure=traceback.format_exc())
    return Verdict(outcome=outcome)


def _read(upload: Upload, reader: Reader) -> tuple[str, str]:
    """Return the outcome, and a fingerprint of all that came."""
    try:
        mesh = reader(upload)
        check_mesh(mesh)
        repaired = repair(mesh)
    except MeshError as refusal:
        check_refusal(refusal)
        return str(refusal.code), refusal.detail
    check_repaired(repaired, mesh)
    return ACCEPTED, _fingerprint(mesh, repaired)


def _inspect(upload: Upload, *, accepted: bool) -> None:
    """Expect that what reading accepts is not refused by its headers."""
    try:
        inspect_upload(upload)
    except MeshError as refusal:
        check_refusal(refusal)
        if accepted:
            raise Broken(f"read, but refused by its headers: {refusal}") from None


def _described(upload: Upload) -> str:
    try:
        check_description(describe(upload, SMALL))
    except MeshError as refusal:
        check_refusal(refusal)
        return str(refusal.code)
    return ACCEPTED


def _fingerprint(mesh: Mesh, repaired: Repaired) -> str:
    digest = hashlib.sha256()
    floats = (mesh.vertices, mesh.corner_colours, mesh.corner_uvs, repaired.vertices)
    whole = (mesh.faces, mesh.face_textures, repaired.faces, repaired.source_faces, repaired.source_corners)
    for contents in (each.tobytes() for arrays in (floats, whole, mesh.textures) for each in arrays):
        digest.update(contents)
    digest.update(repr((mesh.warnings, repaired.warnings, mesh.colour)).encode("utf-8", "surrogatepass"))
    return digest.hexdigest()
