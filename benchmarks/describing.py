"""Describing meshes in processes."""

from collections.abc import Mapping

from threadpoolctl import threadpool_limits

from worker.describe import Description, describe
from worker.reading.upload import Upload


def describe_files(files: Mapping[str, bytes]) -> Description:
    """Describe one mesh on one thread."""
    with threadpool_limits(1):
        return describe(Upload(files=files))
