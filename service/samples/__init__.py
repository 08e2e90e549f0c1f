"""The project's own library: posable coloured creatures and plain things, made wholly by code."""

from service.samples.gallery import count_samples, make_samples
from service.samples.sample import Sample
from service.samples.variety import random_creatures

__all__ = ["Sample", "count_samples", "make_samples", "random_creatures"]
