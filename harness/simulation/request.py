"""The request of a simulation."""

from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction

from ..options import option
from .engines.registry import ENGINES

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
    """How a motion is to be followed."""

    until: Fraction | None = option(None, "The last time, in place of the scene's.", metavar="T")
    # 0 keeps the final state alone
    samples: int | None = option(None, "Keep N equidistant times, not the steps.", metavar="N", least=2)
    # relative
    tol: float | None = option(None, "Tolerance of a step; without it, what the precision holds.")
    # only the Taylor engine knows others than double
    precision: int | str = option("double", "Numbers to use.", metavar="double|extended|quadruple|DIGITS")
    engine: EngineName = option(
        EngineName.AUTO,
        "What follows the motion; auto is the quicker of taylor and runge-kutta, and robust where that fails.",
    )
    stabilization: Stabilization = option(
        Stabilization.PROJECTION,
        "Constraint stabilization; the robust engine always projects. --drift is the former name.",
        alias="drift",
    )
    max_step: float | None = option(None, "No step is to be longer.", metavar="H", above=0)
    sensitivities: tuple[str, ...] = option(
        (),
        "Also find derivatives by these parameters and, for initial values, coordinates and velocities.",
        metavar="NAME,...",
        spelt=("--sensitivity",),
    )
    compact: bool | None = option(None, "heyoka's compact mode; without it, the faster one.")
