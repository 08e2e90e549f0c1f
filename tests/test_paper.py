from index.methods import METHODS
from service.evaluation.paper import PUBLISHED, SYSTEMS, TEST, published
from service.evaluation.protocol import TRANSFORMATIONS


def test_every_system_of_the_paper_is_a_method() -> None:
    assert set(SYSTEMS) <= set(METHODS)
    assert set(PUBLISHED) <= set(SYSTEMS)


def test_figures_are_percentages_of_the_rows_of_the_protocol() -> None:
    for figures in PUBLISHED.values():
        assert set(figures) <= set(TRANSFORMATIONS)
        assert all(0 <= figure <= 100 for figure in figures.values())


def test_what_is_not_known_is_none() -> None:
    assert published(TEST, "chks", "partiality") == 67
    assert published(TEST, "chks", "hue") is None
    assert published(TEST, "meshhog", "hue") is None
    assert published("twins", "chks", "partiality") is None
