import numpy as np
import pytest

from index.errors import BadVocabulary
from index.vocabulary import Softness, Vocabulary, Words, default_vocabulary, learn_vocabulary, softness_of
from worker.parameters import Parameters

Signatures = dict[str, np.ndarray]


def made_signatures(seed: int, n: int = 300) -> Signatures:
    random = np.random.default_rng(seed)
    signatures = {name: random.uniform(1e-4, 1e-3, (n, 6)) for name in ("hks-0", "hks-0.05", "hks-0.1")}
    signatures["log-hks"] = random.normal(-0.5, 0.1, (n, 6))
    signatures["meshhog"] = random.uniform(0, 1, (90 + seed, 96))  # features, not vertices
    signatures["areas"] = random.uniform(1, 5, n)
    signatures["landmark-ladder"] = random.uniform(-9, 0, (256, 28))
    for name in ("diffusion-geometric", "diffusion-joint"):
        signatures[name] = np.sort(random.uniform(0, 1 + seed, 1024))
    return {name: array.astype(np.float32) for name, array in signatures.items()}


def test_a_vocabulary_has_the_words_of_the_paper() -> None:
    vocabulary = learn_vocabulary([made_signatures(seed) for seed in range(5)], "f")
    sizes = {block: len(words.words) for block, words in vocabulary.words.items()}
    assert sizes == {"hks-0": 48, "hks-0.05": 48, "hks-0.1": 48, "log-hks": 128, "meshhog": 48}
    assert set(vocabulary.grids) == {"diffusion-geometric", "diffusion-joint"}


def test_a_library_without_features_gets_a_vocabulary_without_their_words() -> None:
    shapes = [made_signatures(seed) for seed in range(3)]
    for shape in shapes:
        shape["meshhog"] = shape["meshhog"][:0]
    assert "meshhog" not in learn_vocabulary(shapes, "f").words


def test_the_same_shapes_give_the_same_vocabulary() -> None:
    shapes = [made_signatures(seed) for seed in range(3)]
    first, second = learn_vocabulary(shapes, "f"), learn_vocabulary(shapes, "f")
    assert first.id == second.id
    assert first.id != learn_vocabulary(shapes, "g").id


def test_bytes_and_back_is_the_same_vocabulary() -> None:
    vocabulary = learn_vocabulary([made_signatures(0), made_signatures(1)], "f")
    again = Vocabulary.from_bytes(vocabulary.to_bytes())
    assert again.id == vocabulary.id
    assert again.fingerprint == "f"
    for block, words in vocabulary.words.items():
        np.testing.assert_array_equal(again.words[block].words, words.words)
        assert again.words[block].softness == words.softness


def test_words_find_clusters_that_are_there() -> None:
    random = np.random.default_rng(0)
    centres = random.uniform(0, 1, (48, 6))
    shapes = []
    for seed in range(8):
        signatures = made_signatures(seed, 600)
        signatures["hks-0"] = (
            centres[random.integers(0, 48, 600)] + random.normal(0, 1e-3, (600, 6))
        ).astype("f4")
        shapes.append(signatures)
    words = learn_vocabulary(shapes, "f").words["hks-0"].words
    nearest = np.linalg.norm(centres[:, None] - words, axis=2).min(axis=1)
    assert np.mean(nearest < 0.01) > 0.85


def test_softness_rules_are_what_they_say() -> None:
    words = np.array([[0.0], [1.0], [3.0], [7.0]])
    assert softness_of(words, Softness.HARD) == 0.0
    assert softness_of(words, Softness.NEAREST) == 1.5  # of 1, 1, 2, 4
    assert softness_of(words, Softness.PAPER) == 7.0  # twice the median of 1, 2, 3, 4, 6, 7


def test_what_has_no_area_is_not_learnt() -> None:
    signatures = made_signatures(0, 2_000)
    signatures["areas"][1_000:] = 0.0
    signatures["log-hks"][1_000:] = 7.0
    words = learn_vocabulary([signatures], "f").words["log-hks"]
    assert words.centre.max() < 0.0


def test_a_large_library_is_learnt_from_a_bounded_number_of_signatures(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    taken: list[int] = []

    def counted(samples: np.ndarray, *_: object) -> Words:
        taken.append(len(samples))
        return Words(words=samples[:2], centre=samples[0], spread=samples[0], softness=1.0)

    monkeypatch.setattr("index.vocabulary.learn_words", counted)
    monkeypatch.setattr("index.vocabulary.MOST", 1_000)
    learn_vocabulary((made_signatures(seed, 50) for seed in range(40)), "f")
    assert len(set(taken)) == 1
    assert 400 < taken[0] <= 1_000


def test_too_few_shapes_are_refused_in_plain_words() -> None:
    with pytest.raises(BadVocabulary, match="none that is ready"):
        learn_vocabulary([], "f")
    alike = {name: np.ones_like(array) for name, array in made_signatures(0).items()}
    with pytest.raises(BadVocabulary, match="too few"):
        learn_vocabulary([alike], "f")


@pytest.mark.parametrize("data", [b"", b"PK\x03\x04", b"nothing of the kind"])
def test_other_bytes_are_no_vocabulary(data: bytes) -> None:
    with pytest.raises(BadVocabulary):
        Vocabulary.from_bytes(data)


def test_the_default_vocabulary_belongs_to_the_default_parameters() -> None:
    assert default_vocabulary().fingerprint == Parameters().fingerprint()
