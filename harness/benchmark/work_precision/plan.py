"""What a study measures."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from ...program.motion_program import Solve
from ...program.precision import read_precision
from ...simulation.request import Stabilization
from .solvers import SOLVERS


@dataclass(frozen=True)
class Plan:
    """What is measured.

    Attributes
    ----------
    until : Fraction or None
        End of the motion; None for that of the scene's time span.
    tolerances : mapping of str to sequence of float
        Of the Taylor engine, by precision, least demanding first; precisions ascend.
    solver_tolerances : sequence of float
        Of the Runge-Kutta engine, too.
    orders : sequence of int
        Of a single series.
    series_digits : int
        Of rounded coefficients.
    compared_tolerance : float
        At which cures of drift and solves are compared.
    longest_reference : float
        Seconds that a run for the reference may be expected to take.
    """

    until: Fraction | None = None
    tolerances: Mapping[str, Sequence[float]] = field(
        default_factory=lambda: {
            "double": (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16),
            "extended": (1e-14, 1e-16, 1e-18, 1e-19),
            "quadruple": (1e-16, 1e-20, 1e-24, 1e-28, 1e-32, 1e-34),
            "50": (1e-20, 1e-30, 1e-40, 1e-50),
            "100": (1e-40, 1e-60, 1e-80, 1e-100),
        }
    )
    solver_tolerances: Sequence[float] = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13)
    orders: Sequence[int] = (10, 20, 30, 40, 60, 80)
    series_digits: int = 30
    compared_tolerance: float = 1e-10
    longest_reference: float = 15.0

    @property
    def most_digits(self) -> int:
        """Digits of the most precise numbers."""
        return max(read_precision(precision).digits for precision in self.tolerances)

    @property
    def steps(self) -> int:
        """How many candidates there are, at most."""
        ladders = sum(map(len, self.tolerances.values()))
        solvers = (len(SOLVERS) + 1) * len(self.solver_tolerances)  # the one is the Runge-Kutta engine
        return len(self.orders) + ladders + solvers + len(Stabilization) + len(Solve)
