"""Damage to an upload as a whole: names, missing files, contents that changed places."""

import posixpath
from collections.abc import Mapping
from random import Random

_NAMES = (
    *(
        "a.ply",
        "A.PLY",
        "a.obj",
        "a.zip",
        "a.png",
        "a.mtl",
        "",
        ".",
        "..",
        "../a.ply",
        "/a.ply",
        "C:a.ply",
        "a\0.ply",
    ),
    *(
        "a/../../a.obj",
        "a\\..\\b.obj",
        ".a.ply",
        "__MACOSX/a.ply",
        "a" * 3_000 + ".obj",
        "a\n\x1b[31m.ply",
        "a/" * 50,
    ),
    *(
        "é.ply",
        "e\u0301.ply",
        "\udcff.ply",
        "\u202egnp.obj",
        "b'x'.ply",
        "thumbs.db",
        " a.ply ",
        "a.ply/b",
        "//a.ply",
    ),
)
Files = Mapping[str, bytes]


def rename(files: Files, rng: Random) -> Files:
    """Give one file another name."""
    old = rng.choice(list(files))
    folder = posixpath.dirname(old)
    new = rng.choice(
        (old.upper(), old + " ", old[1:], posixpath.join(folder, rng.choice(_NAMES)), rng.choice(_NAMES))
    )
    return {new if name == old else name: data for name, data in files.items()}


def drop(files: Files, rng: Random) -> Files:
    """Leave one file out."""
    gone = rng.choice(list(files))
    return {name: data for name, data in files.items() if name != gone}


def add(files: Files, rng: Random) -> Files:
    """Send one more file: an empty one, or one twice."""
    data = rng.choice((b"", rng.choice(list(files.values()))))
    return {**files, rng.choice(_NAMES): data}


def exchange(files: Files, rng: Random) -> Files:
    """Let two files change their contents."""
    first, second = rng.choice(list(files)), rng.choice(list(files))
    return {**files, first: files[second], second: files[first]}
