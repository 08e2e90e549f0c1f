"""What relations are measured on is what it says, and the tables count it."""

from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from benchmarks.pages import places_of
from benchmarks.relation_meshes import Variant, coarser, exported, subdivided
from benchmarks.relation_telling import Told
from benchmarks.relation_truth import moves_of, truth
from benchmarks.relations import PAGE, pairs_of, scores, tables_of
from service.relations.relation import Relation
from tests.shapes import box, coloured, sphere
from worker.geometry.resampling import face_areas
from worker.reading.mesh import Mesh

REST = Variant(part="validating", model="cow")
BENT = replace(REST, pose="1")
RED = replace(REST, coat="twin 0")
PALE = replace(REST, coat="contrast- 1")
MOVES = {frozenset({("cow", "0"), ("cow", "1")}): 10.0, frozenset({("cow", "0"), ("cow", "2")}): 2.0}
CHANGES = {REST: 0.0, RED: 40.0, PALE: 1.0, BENT: 0.0}


def ball() -> Mesh:
    vertices, faces = sphere(3)
    return coloured(vertices, faces, (vertices + 1.0) / 2.0)


@pytest.mark.parametrize(
    ("other", "relation"),
    [
        (REST, Relation.SAME_FILE),
        (replace(REST, form="exported"), Relation.SAME_SHAPE),
        (RED, Relation.RECOLOURED),
        (PALE, None),  # nobody would see it
        (BENT, Relation.RE_POSED),
        (replace(REST, pose="2"), None),  # it hardly moved
        (replace(RED, pose="1"), Relation.SIMILAR),
        (replace(REST, cut=3), Relation.PART_OF),
        (replace(BENT, cut=3), None),
        (replace(REST, model="horse"), Relation.SIMILAR),
    ],
)
def test_the_truth_of_a_pair_follows_from_how_it_was_made(other: Variant, relation: Relation | None) -> None:
    changes = {**CHANGES, replace(RED, pose="1"): 40.0}
    assert truth(REST, other, changes, MOVES) is truth(other, REST, changes, MOVES) is relation


def test_turned_and_shifted_poses_did_not_move_and_others_did() -> None:
    vertices, faces, colours = box()
    turn = np.array([[0.995, -0.0998, 0.0], [0.0998, 0.995, 0.0], [0.0, 0.0, 1.0]])
    meshes = {
        "0": coloured(vertices, faces, colours),
        "1": coloured(vertices @ turn.T + 0.01, faces, colours),
        "2": coloured(vertices * [1.0, 1.0, 2.0], faces, colours),
    }
    moves = moves_of({("box", pose): partial(meshes.__getitem__, pose) for pose in meshes})
    assert moves[frozenset({("box", "0"), ("box", "1")})] < 1.5
    assert moves[frozenset({("box", "0"), ("box", "2")})] > 3.0


def test_other_meshes_of_a_surface_have_its_area_and_colours() -> None:
    mesh, random = ball(), np.random.default_rng(0)
    area = face_areas(mesh.vertices, mesh.faces).sum()
    for made in (subdivided(mesh, random), coarser(mesh, random)):
        assert face_areas(made.vertices, made.faces).sum() == pytest.approx(area, rel=0.02)
        places = made.vertices[made.faces].reshape(-1, 3)
        expected = (places + 1.0) / 2.0
        assert np.abs(made.corner_colours.reshape(-1, 3) - expected).max() < 0.05
    assert len(subdivided(mesh, random).faces) > len(mesh.faces)


def test_what_is_exported_is_similar_in_the_sense_of_geometry() -> None:
    mesh = ball()
    made = exported(mesh, np.random.default_rng(0))
    assert (len(made.vertices), len(made.faces)) == (len(mesh.vertices), len(mesh.faces))
    edges = [
        np.linalg.norm(m.vertices[m.faces[:, 0]] - m.vertices[m.faces[:, 1]], axis=1) for m in (mesh, made)
    ]
    ratio = np.sort(edges[1]) / np.sort(edges[0])
    np.testing.assert_allclose(ratio, ratio[0], rtol=1e-4)
    assert not np.array_equal(mesh.faces, made.faces)


def test_pairs_of_other_models_are_taken_in_their_own_colours_alone() -> None:
    horse, dyed = replace(REST, model="horse"), replace(RED, model="horse")
    variants = [REST, RED, horse, dyed]
    found = list(pairs_of(variants, dict.fromkeys(variants, 40.0), {}))
    assert (REST, horse, Relation.SIMILAR) in found
    assert (RED, horse, Relation.SIMILAR) not in found


def test_precision_is_of_what_was_told_and_recall_of_what_is_true() -> None:
    counts = {
        (Relation.RE_POSED, "re_posed"): 8,
        (Relation.SIMILAR, "re_posed"): 2,
        (Relation.RE_POSED, "similar"): 24,
    }
    row = next(row for row in scores(counts) if row["relation"] == "`re_posed`")
    assert (row["precision"], row["recall"], row["pairs"]) == ("0.800", "0.250", "32")


def test_the_page_has_a_place_for_each_table() -> None:
    told = [
        Told(part=part, true=Relation.SIMILAR, told="similar", milliseconds=1.0)
        for part in ("choosing", "validating")
    ]
    assert sorted(tables_of(told)) == sorted(places_of(Path(PAGE).read_text(encoding="utf-8")))
