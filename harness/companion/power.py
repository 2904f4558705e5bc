"""Work of forces along a motion."""

import numpy as np
from numpy.typing import NDArray


def work(power: NDArray[np.float64], times: NDArray[np.float64]) -> NDArray[np.float64]:
    """Integrate a power over equidistant times.

    Parameters
    ----------
    power : ndarray, shape (k,)
        Power of the forces.
    times : ndarray, shape (k,)
        Times.

    Returns
    -------
    ndarray, shape (k,)
        Work since the first time.
    """
    from scipy.integrate import cumulative_simpson

    return cumulative_simpson(power, x=times, initial=0.0)
