"""Meshes that are duplicates of each other, with real descriptions in small."""

from tests.serving import Serving
from tests.small_library import good_mesh

HOSTILE = "<img src=x onerror=alert(1)> مزهرية"


def exported_anew(mesh: dict[str, bytes], number: int) -> dict[str, bytes]:
    """Return the same mesh in a file that differs."""
    return {name: ply.replace(b"ply\n", b"ply\ncomment copy %d\n" % number, 1) for name, ply in mesh.items()}


def add_copies(service: Serving, number: int, *names: str) -> list[str]:
    """Add one mesh again and again; return the ids."""
    mesh = good_mesh(number)
    added = [service.add(exported_anew(mesh, place), name=name) for place, name in enumerate(names)]
    assert [answer.status_code for answer in added] == [201] * len(names)
    return [answer.json()["id"] for answer in added]
