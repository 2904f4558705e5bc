"""What a simulation is asked for."""

from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction

FINAL_STATE_ALONE = 0


class EngineName(StrEnum):
    """What follows the motion."""

    AUTO = "auto"
    TAYLOR = "taylor"
    RUNGE_KUTTA = "runge-kutta"
    ROBUST = "robust"


class Stabilization(StrEnum):
    """What keeps the constraints, which the accelerations alone let go: rounding makes f grow with the time.

    ``PROJECTION`` moves the state to the nearest one, in the mass metric, that keeps them; ``BAUMGARTE`` adds damped
    springs to the accelerations (Comput. Methods Appl. Mech. Eng. 1 (1972) 1); ``GGL`` adds to the velocities, too,
    in the way of Gear, Gupta and Leimkuhler (J. Comput. Appl. Math. 12 (1985) 77).
    """

    PROJECTION = "projection"
    BAUMGARTE = "baumgarte"
    GGL = "ggl"
    NONE = "none"


@dataclass(frozen=True)
class SimulationRequest:
    """How a motion is to be followed."""

    tol: float | None = None  # tolerance of a step, relative; None for what the engine and the precision can hold
    # ``double``, ``extended``, ``quadruple``, or a number of decimal digits. Only the Taylor engine knows others than
    # double.
    precision: str | int = "double"
    engine: EngineName = EngineName.AUTO
    # what the Taylor and the Runge-Kutta engine do; the robust one always projects
    drift: Stabilization = Stabilization.PROJECTION
    until: Fraction | None = None  # last instant; None for the end of the scene's time span
    # so many equidistant instants from the first to the last, or, with 0, the final state alone; None for the engine's
    # own steps
    samples: int | None = None
    # whether heyoka compiles in its compact mode; None to choose by what the compilation takes and the run gains
    compact: bool | None = None
    max_step: float | None = None  # time that no step is to exceed; None where the engine alone decides
