import subprocess
import sys
from collections.abc import Callable, Mapping
from itertools import pairwise
from xml.etree import ElementTree

import pytest

from service.evaluation.plots import bars_plot, precision_recall_plot, strength_plot
from service.evaluation.scores import Scores, score
from tests.outcomes import outcome

PLOTS = (precision_recall_plot, strength_plot, bars_plot)
Plot = Callable[[Mapping[str, Scores]], str]


def scores(n_methods: int) -> dict[str, Scores]:
    return score(outcome({f"method-{k}": [1, 1 + k % 3, 2, 4] for k in range(n_methods)}))


def texts(svg: str) -> list[ElementTree.Element]:
    return list(ElementTree.fromstring(svg).iter("{http://www.w3.org/2000/svg}text"))  # noqa: S314 - our own


@pytest.mark.parametrize("plot", PLOTS)
def test_the_same_numbers_give_the_same_bytes(plot: Plot) -> None:
    assert plot(scores(3)) == plot(scores(3))


@pytest.mark.parametrize("plot", PLOTS)
def test_there_is_no_date_and_no_metadata(plot: Plot) -> None:
    svg = plot(scores(2))
    assert "metadata" not in svg
    assert "dc:date" not in svg


@pytest.mark.parametrize("n_methods", [1, 15])
@pytest.mark.parametrize("plot", PLOTS)
def test_every_method_is_named_as_text(plot: Plot, n_methods: int) -> None:
    found = scores(n_methods)
    words = "".join("".join(text.itertext()) for text in texts(plot(found)))
    assert all(method in words.replace("\n", "") for method in found)


def test_labels_of_equal_methods_do_not_overlap() -> None:
    found = score(outcome({f"method-{k}": [1, 1, 1, 1] for k in range(8)}))
    labels = [text for text in texts(precision_recall_plot(found)) if "method" in (text.text or "")]
    heights = sorted(float(text.attrib["y"]) for text in labels)
    assert len(heights) == 8
    assert min(below - above for above, below in pairwise(heights)) > 9  # the height of the letters


def test_a_single_transformation_is_drawn_once() -> None:
    found = score(outcome({"method": [1, 2, 3, 4]}, [("hue", k) for k in range(1, 5)]))
    titles = [text.text for text in texts(strength_plot(found))]
    assert titles.count("hue") == 1
    assert "all" not in titles


@pytest.mark.parametrize("module", ["service.commands.main", "service.evaluation.tables"])
def test_matplotlib_is_imported_by_plots_alone(module: str) -> None:
    code = f"import sys, {module}; sys.exit('matplotlib' in sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_there_is_no_pyplot_and_no_shared_state() -> None:
    code = "import sys, service.evaluation.plots; sys.exit('matplotlib.pyplot' in sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)
