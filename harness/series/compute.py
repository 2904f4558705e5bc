"""The power series of a scene's motion, asked of Maxima or of heyoka."""

from pathlib import Path

from ..documents import ask
from ..formats import Document
from ..sandbox import Limits
from ..source import Source
from .power_series import MotionSeries, read_series
from .request import SeriesRequest


def compute_series(file: Source | Path, request: SeriesRequest, limits: Limits) -> MotionSeries:
    """Expand a scene's motion, in Maxima or, where a precision is asked for, with heyoka.

    Raises
    ------
    HolonomError
        As `holonom.maxima.ask_scene`: among others, the control law is not analytic at t0, or G is singular there. As
        `holonom.series.heyoka_series.expand_by_heyoka`.
    """
    if request.precision is not None:
        from .heyoka_series import expand_by_heyoka

        return expand_by_heyoka(file, request, limits)
    asked = (request.scene, request.order, request.digits, request.until)
    return read_series(ask(Document.MOTION_SERIES, file, *asked, settings=request.settings, limits=limits))
