"""Relations of real descriptions: what a creature is to its copies, its poses, its parts and to others."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cache
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from benchmarks.relation_meshes import exported, subdivided
from service.asking import Question, rank_description
from service.evaluation.damage import cut_away
from service.evaluation.photometric import recolour
from service.intake.submissions import receive_paths
from service.jobs.recording import record_description
from service.library import Library
from service.relations.postures import Postures
from service.relations.relating import relate, relate_stored
from service.relations.relation import Part, Related, Relation
from service.relations.sides import described_side
from service.retrieval import accept_upload, find_similar
from service.samples.creatures import make_creature
from service.samples.palettes import random_coat
from service.samples.writing import ply_bytes
from service.settings import Settings
from service.storage import PREVIEW, derived_key
from tests.backups import claimed
from worker.describe import Description, describe
from worker.reading.mesh import Mesh
from worker.reading.upload import Upload, read_mesh

COAT = random_coat(np.random.default_rng(3))


def creature(kind: str = "grazer", turn: float = 0.0) -> bytes:
    """Return the PLY of a creature whose first joints are turned."""
    pose = {"neck-0": (0.0, turn, 0.0), "neck-1": (0.0, turn, 0.0)} if turn else None
    return ply_bytes(make_creature(kind, COAT, pose, n_vertices=5000))


def obj(mesh: Mesh) -> bytes:
    """Write a mesh with the colour of each vertex, one for each corner."""
    corners = mesh.vertices[mesh.faces].reshape(-1, 3)
    colours = mesh.corner_colours.reshape(-1, 3)
    lines = [
        "v {:.7g} {:.7g} {:.7g} {:.4f} {:.4f} {:.4f}".format(*c, *k)
        for c, k in zip(corners, colours, strict=True)
    ]
    lines += [f"f {3 * i + 1} {3 * i + 2} {3 * i + 3}" for i in range(len(mesh.faces))]
    return "\n".join(lines).encode()


@cache
def files() -> Mapping[str, bytes]:
    """Return the meshes of the library; all but one come from the first."""
    first = creature()
    mesh, random = read_mesh(Upload(files={"a.ply": first})), np.random.default_rng(5)
    return {
        "first.ply": first,
        "again.ply": first,
        "exported.obj": obj(exported(mesh, random)),
        "subdivided.obj": obj(subdivided(mesh, random)),
        "recoloured.obj": obj(recolour(mesh, "hue", 3, random)),
        "bent.ply": creature(turn=35.0),
        "cut.obj": obj(cut_away(mesh, 4, random)),
        "bird.ply": creature("bird"),
    }


@cache
def description(name: str) -> Description:
    return describe(Upload(files={name: files()[name]}))


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Library]:
    """Return a library of these, each named by its file."""
    folder = tmp_path_factory.mktemp("library")
    library = Library.open(Settings(data_dir=folder / "library", reserve_bytes=2**20))
    for name, content in files().items():
        path = folder / name
        path.write_bytes(content)
        accept_upload(library, receive_paths({f"{path.stem}/{name}": path}, name=path.stem))
        record_description(library, claimed(library), description(name))
    yield library
    library.close()


def ids(library: Library) -> dict[str, str]:
    return {shape.name: shape.id for shape in library.catalogue.list().items}


def related(library: Library, one: str, other: str) -> Related:
    known, vocabulary_id = ids(library), library.catalogue.state().vocabulary_id
    found = relate_stored(library, known[one], [known[other]], vocabulary_id or "")
    return found[known[other]]


@pytest.mark.parametrize(
    ("name", "relation"),
    [
        ("again", Relation.SAME_FILE),
        ("exported", Relation.SAME_SHAPE),
        ("subdivided", Relation.SAME_SHAPE),
        ("recoloured", Relation.RECOLOURED),
        ("bent", Relation.RE_POSED),
        ("cut", Relation.PART_OF),
        ("bird", Relation.SIMILAR),
    ],
)
def test_a_creature_is_told_what_each_of_the_others_is(
    library: Library, name: str, relation: Relation
) -> None:
    assert related(library, "first", name).relation is relation


def test_relations_and_their_numbers_are_the_same_both_ways_but_for_the_part(library: Library) -> None:
    for one, other in combinations(ids(library), 2):
        there, back = related(library, one, other), related(library, other, one)
        assert there.relation is back.relation
        turned = {None: None, Part.QUERY: Part.RESULT, Part.RESULT: Part.QUERY}
        assert turned[back.evidence.part] is there.evidence.part
        for name in ("shape_distance", "colour_distance", "pattern_distance", "pose_distance", "misfit"):
            assert getattr(there.evidence, name) == getattr(back.evidence, name)


def test_the_part_is_the_one_that_lost_something(library: Library) -> None:
    assert related(library, "first", "cut").evidence.part is Part.RESULT
    assert related(library, "cut", "first").evidence.part is Part.QUERY


def test_a_mesh_that_is_not_kept_has_the_relations_of_one_that_is(library: Library) -> None:
    for name in ("exported.obj", "bent.ply", "cut.obj"):
        own = description(name)
        found = rank_description(library, own, Question())
        side = described_side(own, found.blocks, [(name, "a sum that no file has")])
        for shape_id, told in relate(library, side, found.registered, found.vocabulary_id).items():
            shape = library.catalogue.get(shape_id)
            if shape.name not in (Path(name).stem, "again"):
                assert told.relation is related(library, Path(name).stem, shape.name).relation


def test_only_results_that_were_compared_twice_have_a_relation(library: Library) -> None:
    one = ids(library)["first"]
    assert all(hit.relation for hit in find_similar(library, one, Question(relations=True)).hits)
    for question in (
        Question(method="chks", relations=True),
        Question(weights={"log-hks": 1.0}, relations=True),
        Question(),
    ):
        assert not any(hit.relation for hit in find_similar(library, one, question).hits)


def test_without_a_preview_nothing_is_told_of_what_needs_it(library: Library) -> None:
    known = ids(library)
    key = derived_key(known["subdivided"], PREVIEW)
    kept = library.files.get(key)
    library.files.delete(key)
    forgetful = replace(library, postures=Postures())
    try:
        hits = {
            hit.shape.name: hit.relation
            for hit in find_similar(forgetful, known["first"], Question(relations=True)).hits
        }
    finally:
        library.files.put(key, kept)
    assert hits["subdivided"] is None
    assert hits["bird"] is not None
