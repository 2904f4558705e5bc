"""The scenes of the register, and their motions, simulated as a user would."""

from collections.abc import Mapping
from fractions import Fraction
from functools import cache
from typing import NamedTuple

import numpy as np

from ...confined import Limits
from ...files import shared
from ...program.motion_problem import MotionProblem, motion_problem
from ...program.motion_program import Solve
from ...program.request import Request
from ...simulation.diagnosis import HardCase
from ...simulation.matrices import Vector
from ...simulation.request import FINAL_STATE_ALONE, SimulationRequest
from ...simulation.simulate import simulate

EXAMPLES = shared("examples")


class Arrived(NamedTuple):
    """Where a simulated motion ends, and what the engine says of it.

    Attributes
    ----------
    engine : str
        Those that followed it, each once.
    state : ndarray, shape (2n,)
        Coordinates, then velocities.
    coordinates, constraint_forces : ndarray, shape (n,)
        No constraint forces where the scene does not observe them.
    multipliers : ndarray, shape (g,)
    residual : float
        Of the constraints.
    energy_error : float
        Its size.
    """

    engine: str
    state: Vector
    coordinates: Vector
    constraint_forces: Vector
    multipliers: Vector
    residual: float
    energy_error: float
    cases: tuple[HardCase, ...]


@cache
def problem(file: str, scene: str | None = None, solve: Solve = Solve.DIRECT) -> MotionProblem:
    """The motion of a scene among the examples.

    Parameters
    ----------
    file : str
        Relative to the examples.
    scene : str, optional
        Without it, the last one.
    """
    return motion_problem(EXAMPLES / file, Request(scene, solve), Limits())


def simulated(motion: MotionProblem, until: float, **asked: object) -> Arrived:
    """Follow a motion with the default engine.

    Parameters
    ----------
    **asked
        What else a `SimulationRequest` takes.

    Raises
    ------
    HolonomError
        The motion cannot be followed so far.
    """
    simulation = simulate(motion, SimulationRequest(until=Fraction(until), samples=FINAL_STATE_ALONE, **asked))
    report = simulation.report
    coordinates, velocities = _numbers(report.coordinates), _numbers(report.velocities)
    return Arrived(
        ", ".join(dict.fromkeys(leg.engine for leg in report.legs)),
        np.concatenate([coordinates, velocities]),
        coordinates,
        _numbers({name: forces[-1] for name, forces in simulation.constraint_forces.items()}),
        _numbers(report.multipliers),
        report.residuals["position"],
        abs(report.energy_error),
        report.cases,
    )


def _numbers(values: Mapping[str, float]) -> Vector:
    return np.array([float(value) for value in values.values()])
