"""The system as described: T, V, Q and f of the chosen effects.

The independent evaluation uses nothing else of a record. Every symbol has a time derivative, the symbol that is its
derivative along the motion:

    q -> dot(q) -> ddot(q) -> dddot(q),   u -> dot(u) -> ddot(u) -> dddot(u),   lambda -> dot(lambda).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import pairwise

import sympy as sp

from ..described import Effect, System


def dotted(dots: str, symbol: sp.Symbol) -> sp.Symbol:
    """Name the derivative of a symbol: ``dotted("ddot", q1)`` is ``ddot(q1)``.

    Parameters
    ----------
    dots : str
        ``dot``, ``ddot`` or ``dddot``.
    symbol : Symbol

    Returns
    -------
    Symbol
    """
    return sp.Symbol(f"{dots}({symbol.name})", real=True)


def initial(symbol: sp.Symbol) -> sp.Symbol:
    """Name the initial value of a symbol.

    Examples are ``q1_0`` of ``q1``, and ``dot(q1)_0`` of ``dot(q1)``.

    Parameters
    ----------
    symbol : Symbol

    Returns
    -------
    Symbol
    """
    return sp.Symbol(f"{symbol.name}_0", real=True)


@dataclass(frozen=True)
class MechanicalSystem:
    """A holonomic system with redundant coordinates and controls, as described."""

    time: sp.Symbol
    coordinates: tuple[sp.Symbol, ...]
    controls: tuple[sp.Symbol, ...]
    multipliers: tuple[sp.Symbol, ...]
    kinetic_energy: sp.Expr
    potential_energy: sp.Expr
    forces: tuple[sp.Expr, ...]
    constraints: tuple[sp.Expr, ...]

    @cached_property
    def velocities(self) -> tuple[sp.Symbol, ...]:
        """The n velocities dot(q)."""
        return tuple(dotted("dot", q) for q in self.coordinates)

    @cached_property
    def accelerations(self) -> tuple[sp.Symbol, ...]:
        """The n accelerations ddot(q)."""
        return tuple(dotted("ddot", q) for q in self.coordinates)

    @cached_property
    def jerks(self) -> tuple[sp.Symbol, ...]:
        """The n jerks dddot(q)."""
        return tuple(dotted("dddot", q) for q in self.coordinates)

    @cached_property
    def multiplier_derivatives(self) -> tuple[sp.Symbol, ...]:
        """The g time derivatives dot(lambda)."""
        return tuple(dotted("dot", multiplier) for multiplier in self.multipliers)

    @cached_property
    def pushing_multipliers(self) -> tuple[sp.Symbol, ...]:
        """The multipliers of constraints that act on bodies.

        They are all but those of normalisations of Euler parameters.
        """
        pairs = zip(self.constraints, self.multipliers, strict=True)
        return tuple(multiplier for constraint, multiplier in pairs if not self._is_normalisation(constraint))

    def _is_normalisation(self, constraint: sp.Expr) -> bool:
        """Return True for e . e = 1 of four coordinates along which there is no inertia."""
        e = [q for q in self.coordinates if constraint.has(q)]
        if len(e) != 4 or sp.expand(constraint + 1 - sum(x**2 for x in e)) != 0:
            return False
        return sp.expand(sum(x * sp.diff(self.kinetic_energy, dotted("dot", x)) for x in e)) == 0

    @cached_property
    def rates(self) -> Mapping[sp.Symbol, sp.Expr]:
        """The time derivative of each symbol that changes along a motion."""
        return {
            self.time: sp.Integer(1),
            **dict(zip(self.multipliers, self.multiplier_derivatives, strict=True)),
            **{
                lower: higher
                for symbol in (*self.coordinates, *self.controls)
                for lower, higher in pairwise(history(symbol))
            },
        }

    @cached_property
    def terms(self) -> tuple[sp.Expr, ...]:
        """Terms of the energies, forces and constraints."""
        described = (self.kinetic_energy, self.potential_energy, *self.forces, *self.constraints)
        return tuple(dict.fromkeys(term for each in described for term in sp.Add.make_args(each)))

    def without(self, redundant: Collection[str]) -> MechanicalSystem:
        """Leave out the constraints whose multipliers have these names.

        Parameters
        ----------
        redundant : collection of str
            Names of multipliers.

        Returns
        -------
        MechanicalSystem
        """
        pairs = [
            (multiplier, f)
            for multiplier, f in zip(self.multipliers, self.constraints, strict=True)
            if multiplier.name not in redundant
        ]
        return replace(
            self, multipliers=tuple(multiplier for multiplier, _ in pairs), constraints=tuple(f for _, f in pairs)
        )

    def time_derivative(self, expression: sp.Expr) -> sp.Expr:
        """Return the total time derivative d/dt of an expression along any motion.

        Parameters
        ----------
        expression : Expr
            Expression in the symbols of the system.

        Returns
        -------
        Expr
        """
        changing = sorted(expression.free_symbols & self.rates.keys(), key=str)
        slopes = gradient(expression, changing)
        return sp.Add(*(slope * self.rates[symbol] for symbol, slope in zip(changing, slopes, strict=True)))


FEW = 4
"""Symbols of a product up to which it is not looked into for a long sum."""


def gradient(expression: sp.Expr, symbols: Sequence[sp.Symbol]) -> list[sp.Expr]:
    """Return partial derivatives by the symbols.

    The time grows with the length of a sum, not with the number of symbols.

    Parameters
    ----------
    expression : Expr
    symbols : sequence of Symbol
        Symbols to differentiate by.

    Returns
    -------
    list of Expr
        One for each symbol.
    """
    terms: dict[sp.Symbol, list[sp.Expr]] = {symbol: [] for symbol in symbols}
    slopes: dict[sp.Symbol, list[sp.Expr]] = {symbol: [] for symbol in symbols}
    for term in sp.Add.make_args(expression):
        present = sorted(term.free_symbols & terms.keys(), key=str)
        factor, rest = term.as_independent(*present, as_Add=False) if len(present) > FEW else (sp.Integer(1), term)
        if isinstance(rest, sp.Add):
            for symbol, slope in zip(present, gradient(rest, present), strict=True):
                slopes[symbol].append(factor * slope)
        else:
            for symbol in present:
                terms[symbol].append(term)
    return [sp.Add(_derivative(sp.Add(*terms[symbol]), symbol), *slopes[symbol]) for symbol in symbols]


@lru_cache(2**16)
def _derivative(expression: sp.Expr, symbol: sp.Symbol) -> sp.Expr:
    """Return a partial derivative. Those of constraints are asked for many times."""
    return expression.diff(symbol)


def history(symbol: sp.Symbol) -> tuple[sp.Symbol, ...]:
    """List a coordinate or control and its first three time derivatives.

    Parameters
    ----------
    symbol : Symbol
        Coordinate or control.

    Returns
    -------
    tuple of Symbol
        q, dot(q), ddot(q), dddot(q).
    """
    return symbol, *(dotted(dots, symbol) for dots in ("dot", "ddot", "dddot"))


def exact(expression: sp.Expr) -> sp.Expr:
    """Return the expression with each decimal number as the fraction that it is.

    Parameters
    ----------
    expression : Expr

    Returns
    -------
    Expr
    """
    return expression.xreplace({number: sp.Rational(number) for number in expression.atoms(sp.Float)})


def described_system(system: System, effects: Collection[str]) -> MechanicalSystem:
    """Take the system of a record with the named effects and switches alone.

    Parameters
    ----------
    system : System
        System of a description or a record.
    effects : collection of str
        Names of effects and switches to take.

    Returns
    -------
    MechanicalSystem
    """
    forces = [effect.value for effect in system.forces if effect.effect in effects]
    switches = {sp.Symbol(name, real=True): sp.Integer(name in effects) for name in system.switches}

    def put_in(expression: sp.Expr) -> sp.Expr:
        return exact(expression).subs(switches)

    return MechanicalSystem(
        time=sp.Symbol(system.time, real=True),
        coordinates=_symbols(system.coordinates),
        controls=_symbols(system.controls),
        multipliers=_symbols(system.multipliers),
        kinetic_energy=put_in(_sum_of(system.kinetic_energy, effects)),
        potential_energy=put_in(_sum_of(system.potential_energy, effects)),
        forces=tuple(put_in(sp.Add(*(force[s] for force in forces))) for s in range(len(system.coordinates))),
        constraints=tuple(map(exact, system.constraints)),
    )


def _symbols(names: Iterable[str]) -> tuple[sp.Symbol, ...]:
    return tuple(sp.Symbol(name, real=True) for name in names)


def _sum_of(parts: Iterable[Effect], effects: Collection[str]) -> sp.Expr:
    return sp.Add(*(part.value for part in parts if part.effect in effects))
