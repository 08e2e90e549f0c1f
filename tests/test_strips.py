import re

from service.evaluation.album import Album
from service.evaluation.scores import score
from service.evaluation.strips import ANSWERS, query_rows
from tests.outcomes import outcome


def answers(rank: int, gallery: int = 12) -> list[tuple[str, int, str]]:
    """Return class, rank and name of the answers to a question whose right answer has a rank."""
    found = outcome({"fused": [rank]}, [("hue", 3)], gallery)
    html = query_rows(found, score(found), [0], ["fused"], Album({}))
    items = re.findall(r'<li class="([\w ]+)" value="(\d+)">.*?title="([^"]+)"', html)
    return [(kind, int(number), name) for kind, number, name in items]


def test_the_right_answer_stands_at_its_rank() -> None:
    found = answers(3)
    assert [kind for kind, _, _ in found] == ["wrong", "wrong", "right", *["wrong after"] * (ANSWERS - 3)]
    assert [number for _, number, _ in found] == list(range(1, ANSWERS + 1))
    assert found[2][2] == "model 0"


def test_a_right_answer_that_comes_later_is_added() -> None:
    found = answers(9)
    assert [kind for kind, _, _ in found] == ["wrong"] * ANSWERS + ["right later"]
    assert found[-1][1:] == (9, "model 0")


def test_a_small_gallery_is_shown_whole() -> None:
    assert [kind for kind, _, _ in answers(2, gallery=3)] == ["wrong", "right", "wrong after"]


def test_each_query_has_a_strip_by_each_method() -> None:
    found = outcome({"fused": [1, 1, 1, 1], "chks": [2, 9, 1, 1]}, gallery=10)
    html = query_rows(found, score(found), [1, 3], ["fused", "chks"], Album({}))
    assert html.count("<article") == 2
    assert html.count("<ol>") == 4
    assert html.count("right at once") == 3
    assert "right answer at rank 9" in html
    assert "<b>hue</b>, strength 5" in html
