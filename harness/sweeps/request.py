"""The request of a sweep."""

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from ..options import option
from ..simulation.request import Stabilization

if TYPE_CHECKING:
    from .axes import Axes
    from .outputs import OutputQuantity

TOLERANCE = 1e-12  # of a step
CHUNK = 10_000


@dataclass(frozen=True)
class SweepRequest:
    """The request of a sweep."""

    axes: "Axes"
    outputs: "tuple[OutputQuantity, ...]"
    tol: float = option(TOLERANCE, "Tolerance of a step.")
    until: Fraction | None = option(None, "Final time. Default: that of the scene.", metavar="T")
    stabilization: Stabilization = option(
        Stabilization.PROJECTION,
        "Constraint stabilization. --drift is the former name.",
        alias="drift",
        choices=(Stabilization.PROJECTION, Stabilization.NONE),
    )
    chunk: int = option(CHUNK, "Rows per file.", metavar="ROWS", least=1, most=10**7)
    # in Python 1, since each process imports the program that asks for more
    workers: int | None = option(
        None, "Number of processes. Default: one per processor.", metavar="N", least=1, most=4096, in_python=1
    )
    scheduler: str | None = option(
        None, "Address of a Dask scheduler whose workers compute.", metavar="ADDRESS", spelt=("--dask",)
    )
    resume: bool = option(False, "Resume a sweep; fail if there is none. Default: resume or start.")
    called: str | None = None  # what the document calls the scene file; None for its path
