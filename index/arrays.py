"""Names for the array types that cross this package's borders."""

import numpy as np
import numpy.typing as npt

SingleArray = npt.NDArray[np.float32]
DoubleArray = npt.NDArray[np.float64]
PositionArray = npt.NDArray[np.int64]
