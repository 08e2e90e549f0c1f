"""Signatures and a vocabulary make the blocks that are compared."""

from collections.abc import Mapping

import numpy as np

from index.errors import FingerprintMismatch
from index.vocabulary import FEATURES, Vocabulary
from worker.arrays import FloatArray, SingleArray
from worker.descriptors.bags import bag_of_features
from worker.descriptors.diffusion import distribution_on_grid


def quantise(signatures: Mapping[str, SingleArray], vocabulary: Vocabulary) -> dict[str, SingleArray]:
    """Turn a shape's signatures into the blocks that depend on a vocabulary.

    Parameters
    ----------
    signatures : mapping of name to array
        As in a `Description`.
    vocabulary : Vocabulary
        Learnt from signatures of the same parameters.

    Returns
    -------
    dict of name to array
        Bags of words, which sum to 1 (to 0 where a shape has no features), and cumulative distributions.
    """
    areas = np.asarray(signatures["areas"], np.float64)
    blocks: dict[str, FloatArray] = {}
    for name, words in vocabulary.words.items():
        standardised = (np.asarray(signatures[name], np.float64) - words.centre) / words.spread
        weights = np.ones(len(standardised)) if name in FEATURES else areas
        blocks[name] = bag_of_features(standardised, weights, words.words, words.softness)
    for name, grid in vocabulary.grids.items():
        blocks[name] = distribution_on_grid(np.asarray(signatures[name], np.float64), grid)
    return {name: block.astype(np.float32) for name, block in blocks.items()}


def require_same(fingerprint: str, vocabulary: Vocabulary) -> None:
    """Refuse to join descriptions and vocabularies of different parameters.

    Raises
    ------
    FingerprintMismatch
    """
    if vocabulary.fingerprint != fingerprint:
        raise FingerprintMismatch(
            f"The vocabulary belongs to descriptors {vocabulary.fingerprint}, these are {fingerprint}."
        )
