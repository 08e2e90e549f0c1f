"""Names for the array types that cross this package's borders."""

from typing import Any

import numpy as np
import numpy.typing as npt

ByteArray = npt.NDArray[np.uint8]
SingleArray = npt.NDArray[np.float32]
DoubleArray = npt.NDArray[np.float64]
PositionArray = npt.NDArray[np.int64]
RowArray = npt.NDArray[Any]  # of bytes or single numbers: shapes as an index keeps them
