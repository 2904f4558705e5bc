"""Compare with `sympy.physics.mechanics.LagrangesMethod`, a third derivation.

The generalized force Q_s is a force on a point that moves with dot(q_s) along one axis. Controls and their
derivatives enter as functions of time. The multipliers of the method's full mass matrix have the paper's sign. Those
in its equations of motion have the opposite one.
"""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp
from sympy.physics.mechanics import LagrangesMethod, Point, ReferenceFrame, dynamicsymbols

from .independent import IndependentEquations
from .linear import LinearEquations
from .system import MechanicalSystem, dotted
from .verdict import Comparison, Pair

LARGEST_SYSTEM = 24
"""Most coordinates and constraints together: the method multiplies dense matrices in symbols."""


def can_take(system: MechanicalSystem) -> bool:
    """Return True if the system is small, and its multipliers linear in the equations.

    Parameters
    ----------
    system : MechanicalSystem

    Returns
    -------
    bool
    """
    acting = {symbol for force in system.forces for symbol in force.free_symbols}
    return acting.isdisjoint(system.multipliers) and len(system.coordinates) + len(system.constraints) <= LARGEST_SYSTEM


def compare(known: IndependentEquations) -> Comparison:
    """Compare accelerations and multipliers with those of the bordered system.

    Parameters
    ----------
    known : IndependentEquations
        The independent evaluation.

    Returns
    -------
    Comparison
    """
    method = _bordered_equations(known.system)
    return Comparison(
        pairs=tuple(
            Pair(symbol.name, of_method, symbol)
            for of_method, symbol in zip(method.unknowns, known.bordered.unknowns, strict=True)
        ),
        solves=(method, known.bordered),
    )


def _bordered_equations(system: MechanicalSystem) -> LinearEquations:
    """Write the method's full mass matrix and forcing in Holonom's symbols.

    The unknowns are new symbols.
    """
    symbols = {function: symbol for symbol, function in _functions_of_time(system).items()}
    method = _method(system)
    method.form_lagranges_equations()
    n = len(system.coordinates)
    unknowns = tuple(dotted("method", symbol) for symbol in (*system.accelerations, *system.multipliers))
    matrix = method.mass_matrix_full[n:, n:].xreplace(symbols)
    forcing = method.forcing_full[n:, :].xreplace(symbols).doit()  # |x| leaves dx/dx
    return LinearEquations(unknowns, tuple(matrix * sp.Matrix(unknowns) - forcing))


def _method(system: MechanicalSystem) -> LagrangesMethod:
    functions = _functions_of_time(system)
    frame = ReferenceFrame("N")
    forces = [
        (_point_moving_with(v.xreplace(functions), frame), force.xreplace(functions) * frame.x)
        for v, force in zip(system.velocities, system.forces, strict=True)
    ]
    return LagrangesMethod(
        (system.kinetic_energy - system.potential_energy).xreplace(functions),
        [q.xreplace(functions) for q in system.coordinates],
        forcelist=forces,
        frame=frame,
        hol_coneqs=[f.xreplace(functions) for f in system.constraints] or None,
    )


def _point_moving_with(speed: sp.Expr, frame: ReferenceFrame) -> Point:
    point = Point("P")
    point.set_vel(frame, speed * frame.x)
    return point


def _functions_of_time(system: MechanicalSystem) -> Mapping[sp.Symbol, sp.Expr]:
    """Map t, q, u and their derivatives to the method's functions of time."""
    time = dynamicsymbols._t
    functions: dict[sp.Symbol, sp.Expr] = {system.time: time}
    for symbol in (*system.coordinates, *system.controls):
        function = sp.Function(symbol.name, real=True)(time)  # Abs has a derivative then
        functions[symbol] = function
        functions[dotted("dot", symbol)] = function.diff(time)
        functions[dotted("ddot", symbol)] = function.diff(time, 2)
    return functions
