"""Equations (10), (12), (13), (18), (19) of a scene, each against the independent evaluation.

The control law enters as the values of u and its rates, never substituted into an equation. The
series is compared coefficient by coefficient: initial accelerations from the bordered system,
initial jerks from the bordered system differentiated once more along the motion.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import sympy as sp

from ..record import Relation, Scene
from .claims import NotComparable, entries_of, require_names, solved_for
from .derivation import DerivationClaims
from .independent import IndependentEquations
from .system import MechanicalSystem, history, initial
from .verdict import Comparison, Pair

Relations = Sequence[Relation]
Definitions = Mapping[sp.Symbol, sp.Expr]


@dataclass(frozen=True)
class SceneClaims:
    """A scene of the record beside the derivation it rests on."""

    scene: Scene
    derivation: DerivationClaims

    @property
    def known(self) -> IndependentEquations:
        """The independent evaluation of the independent constraints of the scene's system."""
        return self.derivation.known

    @property
    def system(self) -> MechanicalSystem:
        """The system, with the effects that the scene calls for."""
        return self.derivation.system

    @property
    def initial_instant(self) -> sp.Expr:
        """t0, the beginning of the time span; zero where there is none."""
        return self.scene.time_span[0] if self.scene.time_span else sp.Integer(0)

    @cached_property
    def state(self) -> tuple[sp.Symbol, ...]:
        """Coordinates and velocities."""
        return (*self.system.coordinates, *self.system.velocities)

    @cached_property
    def control_law(self) -> Definitions:
        """Controls and their rates as functions of time, by the scene's control law."""
        definitions: dict[sp.Symbol, sp.Expr] = {}
        for name, law in self.scene.control_law.items():
            for symbol in history(sp.Symbol(name, real=True)):
                definitions[symbol] = law
                law = law.diff(self.system.time)
        return definitions

    @cached_property
    def controls_at_start(self) -> Definitions:
        """The initial instant and the controls then; those without a law have values u_0, ..."""
        without_law = (
            symbol for control in self.system.controls if control not in self.control_law for symbol in history(control)
        )
        return {
            self.system.time: self.initial_instant,
            **self.control_law,
            **{symbol: initial(symbol) for symbol in without_law},
        }

    @cached_property
    def start(self) -> Definitions:
        """The initial instant, the controls and the state then, in symbols q1_0, dot(q1)_0."""
        return {**self.controls_at_start, **{symbol: initial(symbol) for symbol in self.state}}

    @cached_property
    def configuration(self) -> Definitions:
        """The initial instant, parameters, controls and coordinates, as far as the scene has numbers for them."""
        parameters = {sp.Symbol(x, real=True): y for x, y in self.scene.parameter_values.items()}
        values = {sp.Symbol(x, real=True): y for x, y in self.scene.initial_state.items()}
        known = {**values, **self.controls_at_start, **parameters}
        at_start = {
            symbol: value.xreplace(self.controls_at_start).xreplace(parameters) for symbol, value in known.items()
        }
        return {symbol: value for symbol, value in at_start.items() if value.is_number}

    def certificate(self, *solutions: Definitions) -> Definitions | None:
        """Claimed closed forms of the motion at the start, with the record's multipliers."""
        multipliers = self.derivation.multipliers()
        if multipliers is None:
            return None
        rates = {self.system.rates[symbol]: self.system.total_rate(value) for symbol, value in multipliers.items()}
        together: dict[sp.Symbol, sp.Expr] = {}
        for solution in (*solutions, multipliers, rates):
            together.update(solution)
        return together


def free_motion_condition(claims: SceneClaims, relations: Relations) -> Comparison:
    """(10) under the control law: constraint accelerations where every multiplier is zero."""
    require_names(("residual",), relations)
    expected = claims.known.constraint_accelerations
    claimed = entries_of("residual", (len(expected),), relations)
    return Comparison(
        tuple(
            Pair(f"condition of free motion {beta}", claimed.get((beta,), sp.Integer(0)), residual)
            for beta, residual in enumerate(expected, start=1)
        ),
        given=claims.control_law,
        solves=(claims.known.free,),
        certificate=claims.derivation.free_accelerations(),
    )


def initial_state(claims: SceneClaims, relations: Relations) -> Comparison:
    """(12): the constraints and their first rates vanish at the initial state."""
    names = tuple(map(initial, claims.state))
    claimed = solved_for(names, relations)
    stated = {initial(sp.Symbol(x, real=True)): y for x, y in claims.scene.initial_state.items()}
    if stated.keys() != set(names):
        raise NotComparable("an initial state that is not complete")
    parameters = {sp.Symbol(x, real=True): y for x, y in claims.scene.parameter_values.items()}
    return Comparison(
        (
            *(Pair(name.name, claimed[name], stated[name]) for name in names),
            *_vanishing("constraint", claims.system.constraints),
            *_vanishing("rate of constraint", claims.derivation.stated.constraint_rates),
        ),
        given={**parameters, **claimed, **claims.start},
    )


def determined_initial_values(claims: SceneClaims, relations: Relations) -> Comparison:
    """(19): all values left out are there; with them put in, the constraints they come from vanish identically.

    A value that is a number, in constraints that contain other initial values besides, is one for the scene's own
    numbers only: it is compared with the initial state, for which (12) has the constraints.
    """
    fixed = {relation.left: relation.right for relation in relations}
    left_out = {initial(symbol) for symbol in claims.state if symbol.name not in claims.scene.given}
    if len(fixed) < len(relations) or fixed.keys() != left_out:
        raise NotComparable(f"values of {_names(fixed)} where the scene leaves out {_names(left_out)}")
    stated = {initial(sp.Symbol(x, real=True)): y for x, y in claims.scene.initial_state.items()}
    residuals = [
        *_for_all_states(claims.system.coordinates, claims.known.system.constraints, fixed),
        *_for_all_states(claims.system.velocities, claims.known.constraint_rates, fixed),
    ]
    numbers = [name for name, value in fixed.items() if value.is_number]
    return Comparison(
        (
            *_vanishing("constraint", residuals),
            *(Pair(name.name, fixed[name], stated[name]) for name in numbers if stated[name].is_number),
        ),
        given={**fixed, **claims.start},
    )


def _for_all_states(
    symbols: Iterable[sp.Symbol], residuals: Iterable[sp.Expr], fixed: Mapping[sp.Symbol, sp.Expr]
) -> Iterable[sp.Expr]:
    """Residuals that contain fixed symbols, and no symbol that is fixed for the scene's numbers only."""
    symbols = set(symbols)
    known = {symbol for symbol in symbols if initial(symbol) in fixed}
    numbers = {symbol for symbol in known if fixed[initial(symbol)].is_number}
    for residual in residuals:
        present = residual.free_symbols & symbols
        if present & known and not (present & numbers and present - numbers):
            yield residual


def _names(symbols: Iterable[sp.Symbol]) -> str:
    return ", ".join(sorted(symbol.name for symbol in symbols)) or "nothing"


def initial_accelerations(claims: SceneClaims, relations: Relations) -> Comparison:
    """(13): the accelerations of the bordered system at the start."""
    system = claims.system
    claimed = solved_for([initial(a) for a in system.accelerations], relations)
    solution = {a: claimed[initial(a)] for a in system.accelerations}
    return Comparison(
        tuple(Pair(initial(a).name, value, a) for a, value in solution.items()),
        given=claims.start,
        solves=(claims.known.bordered,),
        certificate=claims.certificate(solution),
    )


def initial_series(claims: SceneClaims, relations: Relations) -> Comparison:
    """(18): the series, to the third order, is that of the motion; and it ends there."""
    system = claims.system
    claimed = solved_for(system.coordinates, relations)
    rates: dict[sp.Symbol, sp.Expr] = {}
    pairs = []
    for q, series in claimed.items():
        for symbol in history(q):
            rates[symbol] = series.xreplace({system.time: claims.initial_instant})
            pairs.append(Pair(initial(symbol).name, rates[symbol], symbol))
            series = series.diff(system.time)
        pairs.append(Pair(f"remainder of the series of {q}", series, sp.Integer(0)))
    highest = {x: rates[x] for x in (*system.accelerations, *system.jerks)}
    return Comparison(
        tuple(pairs),
        given=claims.start,
        solves=(claims.known.bordered, claims.known.bordered_rates),
        certificate=claims.certificate(highest),
    )


def _vanishing(what: str, expressions: Iterable[sp.Expr]) -> Iterable[Pair]:
    for i, expression in enumerate(expressions, start=1):
        yield Pair(f"{what} {i}", sp.Integer(0), expression)


COMPARISONS = {
    "free_motion_residual": free_motion_condition,
    "initial_state": initial_state,
    "initial_accelerations": initial_accelerations,
    "initial_series": initial_series,
    "determined_initial_values": determined_initial_values,
}
"""The comparison that decides each equation of a scene, by its id."""
