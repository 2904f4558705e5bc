"""The request of a simulation."""

from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction
from typing import TYPE_CHECKING

from ..options import option
from .engines.registry import ENGINES

if TYPE_CHECKING:
    from ..program.precision import Precision

FINAL_STATE_ALONE = 0


# ``AUTO``, and what the registry names
EngineName = StrEnum("EngineName", {each.upper().replace("-", "_"): each for each in ("auto", *ENGINES)})


class Stabilization(StrEnum):
    """The method of constraint stabilization against drift by rounding.

    ``PROJECTION`` moves the state to the nearest one, in the mass metric, that satisfies the constraints. ``BAUMGARTE``
    adds damped springs to the accelerations (Comput. Methods Appl. Mech. Eng. 1 (1972) 1). ``GGL`` also changes the
    velocities, as Gear, Gupta and Leimkuhler do (J. Comput. Appl. Math. 12 (1985) 77).
    """

    PROJECTION = "projection"
    BAUMGARTE = "baumgarte"
    GGL = "ggl"
    NONE = "none"


@dataclass(frozen=True, kw_only=True)
class SimulationRequest:
    """A request for a simulation."""

    until: Fraction | None = option(None, "Final time. Default: that of the scene.", metavar="T")
    # 0 keeps the final state alone
    samples: int | None = option(None, "Output N equally spaced samples. Default: one per step.", metavar="N", least=2)
    # relative
    tol: float | None = option(None, "Relative tolerance of a step. Default: the rounding error of the precision.")
    # only the Taylor engine knows others than double
    precision: int | str = option("double", "Floating-point precision.", metavar="double|extended|quadruple|DIGITS")
    engine: EngineName = option(
        EngineName.AUTO,
        "Integrator. auto uses the faster of taylor and runge-kutta, and robust near singular configurations.",
    )
    stabilization: Stabilization = option(
        Stabilization.PROJECTION,
        "Constraint stabilization. The robust engine always projects. --drift is the former name.",
        alias="drift",
    )
    max_step: float | None = option(None, "Largest step.", metavar="H", above=0)
    sensitivities: tuple[str, ...] = option(
        (),
        "Compute derivatives by these parameters and initial coordinates or velocities.",
        metavar="NAME,...",
        spelt=("--sensitivity",),
    )
    compact: bool | None = option(None, "heyoka's compact mode. Default: the faster mode.")

    @property
    def numbers(self) -> "Precision":
        """The numbers of the requested precision."""
        from ..program.precision import read_precision  # imports NumPy, which options do not need

        return read_precision(str(self.precision))
