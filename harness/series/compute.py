"""The power series of a scene's motion, by Maxima or heyoka."""

from pathlib import Path

from ..documents import Argument, ask
from ..failures import ErrorKind, HolonomError
from ..formats import Document, read
from ..sandbox import Limits
from ..source import Source
from .power_series import MotionSeries
from .request import SeriesRequest


def compute_series(file: Source | Path, request: SeriesRequest, limits: Limits) -> MotionSeries:
    """Expand a scene's motion, by Maxima, or by heyoka if a precision is given.

    Parameters
    ----------
    file : Source or Path
        Scene file.
    request : SeriesRequest
        Scene, order and numbers to compute with.
    limits : Limits
        Limits of each run of Maxima.

    Returns
    -------
    MotionSeries
        Coefficients about the initial time, and the continuation if the request has an end. Derivatives of the
        coefficients have the names ``d(x, m)``.

    Raises
    ------
    HolonomError
        As `holonom.documents.ask`: among others, the control law is not analytic at t0, or G is singular there. As
        `holonom.series.heyoka_series.expand_by_heyoka`.
    """
    if request.precision is not None:
        if request.sensitivities:
            raise HolonomError(ErrorKind.SERIES_VARIED)
        from .heyoka_series import expand_by_heyoka

        return expand_by_heyoka(file, request, limits)
    directions = [_direction(name) for name in request.sensitivities]
    asked = (request.scene, request.order, request.digits, request.until, directions)
    text = ask(Document.MOTION_SERIES, file, *asked, settings=request.settings, limits=limits)
    return read(Document.MOTION_SERIES, text, MotionSeries)


def _direction(name: str) -> Argument:
    """Return a name for Maxima. A velocity ``dot(x)`` as the names dot and x."""
    return ["dot", name[4:-1]] if name.startswith("dot(") and name.endswith(")") else name
