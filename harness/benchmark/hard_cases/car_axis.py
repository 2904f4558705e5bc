"""The car axis on a bumpy road: stiff springs between wheels and chassis, under two constraints, one of them rheonomic.

References
----------
Mazzia & Magherini, Test Set for Initial Value Problem Solvers, problem caraxis; the values are those of the package
deTestSet for R, which are right to about twelve decimals.
"""

from mpmath import mpf

from ...simulation.diagnosis import HardCase
from .case import Case, Extent, Findings, found, ours, theirs
from .digits import digits_kept
from .plain import PLAIN, plain_motion
from .scenes import problem, simulated

FILE, UNTIL = "car_axis.mac", 3
NEEDED = 10.0
PUBLISHED = tuple(
    map(
        mpf,
        ("0.0493455784275402809122", "0.496989460230171153861", "1.04174252488542151681", "0.373911027265361256927"),
    )
)
"""xl, yl, xr, yr at t = 3."""


def examine(extent: Extent) -> Findings:
    """Digits of the published places, by the plain way and by ours."""
    motion, plain = simulated(problem(FILE), until=UNTIL, tol=1e-14), plain_motion(problem(FILE), UNTIL)
    quantity = f"places at t = {UNTIL}"
    return found(
        theirs(PLAIN, quantity, digits_kept(plain[: len(PUBLISHED)], PUBLISHED, 1), NEEDED),
        ours(motion.engine, quantity, digits_kept(motion.coordinates, PUBLISHED, 1), NEEDED),
    )


CASE = Case(
    name="car axis",
    kind=HardCase.STIFF,
    truth="the published solution, right to about twelve decimals",
    examine=examine,
)
