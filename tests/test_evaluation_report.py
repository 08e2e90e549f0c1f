import io
import re
from collections import Counter
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from service.evaluation.outcome import Outcome
from service.evaluation.report import shown_methods, write_report
from service.evaluation.scores import score
from tests.outcomes import outcome

VOID = {"meta", "link", "img", "wbr", "image", "use"}
EVIL = '<script>alert("1")</script>'


class Page(HTMLParser):
    """Collects what a page refers to, and notices elements that are not closed."""

    def __init__(self, content: str) -> None:
        super().__init__()
        self.ids: Counter[str] = Counter()
        self.references: list[str] = []
        self.tags: Counter[str] = Counter()
        self.images: list[dict[str, str | None]] = []
        self._open: list[str] = []
        self.feed(content)
        assert not self._open

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note an element and its addresses."""
        given = dict(attrs)
        self.tags[tag] += 1
        if given.get("id"):
            self.ids[str(given["id"])] += 1
        self.references += [str(given[name]) for name in ("href", "src") if name in given]
        if tag == "img":
            self.images.append(given)
        if tag not in VOID:
            self._open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note an element without content."""
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self._open.pop()

    def handle_endtag(self, tag: str) -> None:
        """Check that the innermost open element closes."""
        assert self._open.pop() == tag


def pictures(*outcomes: Outcome) -> dict[str, bytes]:
    names = [name for found in outcomes for name in found.gallery]
    names += [question.name for found in outcomes for question in found.questions]
    made = {}
    for number, name in enumerate(dict.fromkeys(names)):
        content = io.BytesIO()
        Image.new("RGBA", (256, 256), (37 * number % 256, 91 * number % 256, 90, 255)).save(content, "PNG")
        made[name] = content.getvalue()
    return made


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> str:
    first = outcome({"fused": [1, 2, 1, 8], "chks": [3, 1, 5, 2]})
    second = outcome({"hks": [1, 1, 2, 1]}, test="twins", title=f"Twins {EVIL}")
    path = tmp_path_factory.mktemp("report") / "report.html"
    write_report(path, [first, second], pictures(first, second), {"folder": EVIL, "models": 8})
    return path.read_text(encoding="utf-8")


def test_it_refers_to_nothing_outside(written: str) -> None:
    references = Page(written).references
    assert all(reference.startswith(("#", "data:")) for reference in references)
    assert "url(" not in written
    assert "@import" not in written
    assert "http" not in re.sub(r"base64,[^\"]+", "", written)


def test_what_it_refers_to_inside_exists_once(written: str) -> None:
    page = Page(written)
    assert set(page.ids.values()) == {1}
    assert {reference[1:] for reference in page.references if reference.startswith("#")} <= set(page.ids)


def test_each_picture_is_there_once_and_every_plot_is_described(written: str) -> None:
    embedded = re.findall(r"data:image/webp;base64,([^\"]+)", written)
    assert len(embedded) == len(set(embedded)) > 8
    images = Page(written).images
    assert len(images) == 6
    assert all(image["alt"] for image in images)


def test_text_is_escaped(written: str) -> None:
    assert Page(written).tags["script"] == 0
    assert "&lt;script&gt;" in written


def test_the_key_table_comes_first_then_tests_then_queries(written: str) -> None:
    places = [written.index(part) for part in ("<h1>", "<table>", 'id="paper"', 'id="twins"', 'id="queries"')]
    assert places == sorted(places)


def test_failures_of_the_best_method_are_told(written: str) -> None:
    assert "<code>hks</code> is not right at once in 1 of 4 queries" in written


def test_the_same_outcome_gives_the_same_bytes(tmp_path: Path) -> None:
    found = outcome({"fused": [1, 2, 1, 8]})
    for name in ("a.html", "b.html"):
        write_report(tmp_path / name, [found], pictures(found), {"models": 8})
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()


def test_pictures_may_be_missing(tmp_path: Path) -> None:
    found = outcome({"fused": [1, 1, 1, 1]})
    write_report(tmp_path / "report.html", [found], {}, {})
    assert "<code>fused</code> is always right at once" in (tmp_path / "report.html").read_text(
        encoding="utf-8"
    )


def test_many_queries_of_noisy_pictures_stay_below_3_megabytes(tmp_path: Path) -> None:
    kinds = [(f"change {k % 11}", 1 + k % 5) for k in range(880)]
    random = np.random.default_rng(0)
    found = outcome({name: random.integers(1, 70, 880).tolist() for name in "abcdefg"}, kinds, gallery=70)
    made = {}
    for name in pictures(found):
        content = io.BytesIO()
        small = random.integers(0, 256, (32, 32, 3), dtype=np.uint8)
        Image.fromarray(small).resize((128, 128)).save(content, "PNG", compress_level=1)
        made[name] = content.getvalue()
    write_report(tmp_path / "report.html", [found], made, {})
    assert (tmp_path / "report.html").stat().st_size < 3_000_000


def test_methods_that_an_outcome_lacks_are_replaced_or_left_out() -> None:
    scores = score(outcome({"a": [2] * 4, "b": [1] * 4, "chks": [3] * 4}))
    assert shown_methods(scores, "a", "chks") == ["a", "chks"]
    assert shown_methods(scores, "fused", "chks") == ["b", "chks"]
    assert shown_methods(scores, "fused", "hks") == ["b"]
    assert shown_methods(scores, "a", "hks") == ["a", "b"]
