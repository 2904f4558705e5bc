"""A third opinion: Lagrange's equations as `sympy.physics.mechanics.LagrangesMethod` forms them.

The generalized force Q_s is handed over as the force on a point that moves with dot(q_s) along
one axis. Controls and their rates enter as functions of time. The multipliers of the method's
full mass matrix have the paper's sign; those in its equations of motion have the opposite one.
"""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp
from sympy.physics.mechanics import LagrangesMethod, Point, ReferenceFrame, dynamicsymbols

from .independent import IndependentEquations
from .linear import LinearEquations
from .report import Item
from .system import MechanicalSystem, dotted
from .verdict import Comparison, Pair

OPINION = Item("lagranges_method", "2", "Lagrange's equations (SymPy LagrangesMethod)")

LARGEST_SYSTEM = 24
"""Most coordinates and constraints together: the method multiplies dense matrices in symbols."""


def can_take(system: MechanicalSystem) -> bool:
    """Return True if the method is asked about a system."""
    return len(system.coordinates) + len(system.constraints) <= LARGEST_SYSTEM


def compare(known: IndependentEquations) -> Comparison:
    """Accelerations and multipliers of the method against those of the bordered system."""
    theirs = _bordered_equations(known.system)
    return Comparison(
        pairs=tuple(
            Pair(ours.name, their_own, ours)
            for their_own, ours in zip(theirs.unknowns, known.bordered.unknowns, strict=True)
        ),
        solves=(theirs, known.bordered),
    )


def _bordered_equations(system: MechanicalSystem) -> LinearEquations:
    """Write the method's full mass matrix and forcing in our symbols, for unknowns of its own."""
    ours = {function: symbol for symbol, function in _functions_of_time(system).items()}
    method = _method(system)
    method.form_lagranges_equations()
    n = len(system.coordinates)
    unknowns = tuple(dotted("method", symbol) for symbol in (*system.accelerations, *system.multipliers))
    matrix = method.mass_matrix_full[n:, n:].xreplace(ours)
    forcing = method.forcing_full[n:, :].xreplace(ours).doit()  # |x| leaves dx/dx
    return LinearEquations(unknowns, tuple(matrix * sp.Matrix(unknowns) - forcing))


def _method(system: MechanicalSystem) -> LagrangesMethod:
    theirs = _functions_of_time(system)
    frame = ReferenceFrame("N")
    forces = [
        (_point_moving_with(v.xreplace(theirs), frame), force.xreplace(theirs) * frame.x)
        for v, force in zip(system.velocities, system.forces, strict=True)
    ]
    return LagrangesMethod(
        (system.kinetic_energy - system.potential_energy).xreplace(theirs),
        [q.xreplace(theirs) for q in system.coordinates],
        forcelist=forces,
        frame=frame,
        hol_coneqs=[f.xreplace(theirs) for f in system.constraints] or None,
    )


def _point_moving_with(speed: sp.Expr, frame: ReferenceFrame) -> Point:
    point = Point("P")
    point.set_vel(frame, speed * frame.x)
    return point


def _functions_of_time(system: MechanicalSystem) -> Mapping[sp.Symbol, sp.Expr]:
    """For t, q, u and their rates the method's time, functions of time and derivatives."""
    time = dynamicsymbols._t
    functions: dict[sp.Symbol, sp.Expr] = {system.time: time}
    for symbol in (*system.coordinates, *system.controls):
        function = sp.Function(symbol.name, real=True)(time)  # Abs has a derivative then
        functions[symbol] = function
        functions[dotted("dot", symbol)] = function.diff(time)
        functions[dotted("ddot", symbol)] = function.diff(time, 2)
    return functions
