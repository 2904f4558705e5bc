"""Power of the constraint forces along a motion, and its energy balance."""

from dataclasses import dataclass

import numpy as np
import sympy
from numpy.typing import NDArray
from sympy import Expr, Symbol

from ..record import Scene, System
from ..simulation.result import Simulation
from .expressions import at, under


@dataclass(frozen=True)
class EnergyBalance:
    """Energy balance of a motion: arrays of shape (k,) at its times."""

    power: NDArray[np.float64]  # of the reactions, -lambda (df/dt + du/dt df/du)
    gained: NDArray[np.float64]  # kinetic energy since the initial time
    # by_forces, by_controls: work of the forces and of the reactions since then
    by_forces: NDArray[np.float64]
    by_controls: NDArray[np.float64]

    @property
    def error(self) -> float:
        """The largest energy that no work accounts for."""
        return float(np.max(np.abs(self.gained - self.by_forces - self.by_controls)))


def energy_balance(system: System, scene: Scene, motion: Simulation) -> EnergyBalance:
    """Take stock of the energy of a motion, from the description of the system alone.

    The system has no potential energy. The motion has multipliers, at many equidistant times.

    Parameters
    ----------
    system : System
        Description of the system.
    scene : Scene
        Scene of the motion.
    motion : Simulation
        Simulated motion.

    Returns
    -------
    EnergyBalance
        Work and energy along the motion.
    """
    from scipy.integrate import cumulative_simpson

    from ..crosscheck.independent import power_of_forces, reaction_power
    from ..crosscheck.system import described_system

    described = described_system(system, scene.effects)
    power, forces, kinetic = (
        values_along(expression, scene, motion)
        for expression in (reaction_power(described), power_of_forces(described), described.kinetic_energy)
    )
    times = motion.times.astype(float)
    by_forces, by_controls = (cumulative_simpson(rate, x=times, initial=0.0) for rate in (forces, power))
    return EnergyBalance(power, kinetic - kinetic[0], by_forces, by_controls)


def values_along(expression: Expr, scene: Scene, motion: Simulation) -> NDArray[np.float64]:
    """Return the values of an expression along a motion.

    Parameters
    ----------
    expression : Expr
        SymPy expression.
    scene : Scene
        Scene of the motion.
    motion : Simulation
        Simulated motion.

    Returns
    -------
    ndarray
        Value at each sample.
    """
    known = {"t": motion.times, **motion.coordinates, **motion.velocities, **motion.multipliers}
    expression = at(under(scene.control_law, expression), scene.parameter_values)
    names = sorted(str(symbol) for symbol in expression.free_symbols)
    function = sympy.lambdify([Symbol(name, real=True) for name in names], expression, "numpy")
    found = function(*(np.asarray(known[name], dtype=float) for name in names))
    return np.broadcast_to(np.asarray(found, dtype=float), motion.times.shape)
