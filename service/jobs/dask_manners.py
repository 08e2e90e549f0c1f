"""How Dask behaves inside our processes: its messages go where ours go."""

import logging
from typing import Any

import dask.config


def teach_dask(**configuration: Any) -> None:
    """Set what Dask is told, and hand its log lines on to whoever logs here, from warnings up.

    Parameters
    ----------
    **configuration
        Names of Dask's configuration, with ``__`` for each full stop.
    """
    dask.config.set(**configuration)
    for name in list(logging.root.manager.loggerDict):
        if name == "distributed" or name.startswith("distributed."):
            logger = logging.getLogger(name)
            logger.handlers.clear()
            logger.propagate = True
            logger.setLevel(logging.NOTSET)
    logging.getLogger("distributed").setLevel(logging.WARNING)
