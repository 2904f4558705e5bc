"""Equations (10), (12), (13), (18), (19) of a scene, each checked independently.

The control law enters as the values of u and its derivatives, never substituted into an equation. The series is
compared coefficient by coefficient: initial accelerations from the bordered system, initial jerks from the bordered
system differentiated once more along the motion.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf

import sympy as sp
from mpmath import mp

from ..description import DescribedScene
from ..language import translatable
from ..record import Relation, Scene
from .behind import form_behind
from .derivation import CheckedDerivation
from .digits import WORKING_DIGITS
from .evaluation import Steps
from .independent import IndependentEquations
from .normal_form import is_identically_zero
from .ranks import Elimination
from .relations import NotComparable, list_of, numbered, solved_for
from .system import MechanicalSystem, exact, gradient, history, initial
from .verdict import Comparison, Pair

STATED_DIGITS = 2
"""Digits in which a stated correction is the one that was made."""

LIMITED_DIGITS = mp.mpf("2e-9")
"""Largest correction of given values, as a share of the largest of them."""

SAME = mp.mpf("1e-9")
"""Relative difference of two corrections of which either is the largest."""

FEWEST_ROUNDED_DIGITS = 25
"""Digits of the denominator of a number that may be rounded."""

SHORTENED = 4  # at most, the length of residuals in terms of that of a closed form made of them
MANY_TOGETHER = 4
"""Initial values that equations fix together: such closed forms may be too long."""

Relations = Sequence[Relation]
Definitions = Mapping[sp.Symbol, sp.Expr]


@dataclass(frozen=True)
class CheckedScene:
    """A scene of the record, with its premises and its derivation."""

    scene: Scene
    premises: DescribedScene
    derivation: CheckedDerivation

    @property
    def known(self) -> IndependentEquations:
        """The independent evaluation with the independent constraints of the system."""
        return self.derivation.known

    @property
    def system(self) -> MechanicalSystem:
        """The system, with the effects that the scene calls for."""
        return self.derivation.system

    @cached_property
    def beginning(self) -> IndependentEquations:
        """The independent evaluation with signs of functions of the time after t0."""
        return self._beginning(self.derivation.known)

    @cached_property
    def stated(self) -> IndependentEquations:
        """The beginning with all constraints of the system."""
        return self._beginning(self.derivation.stated)

    def _beginning(self, equations: IndependentEquations) -> IndependentEquations:
        def formed(expression: sp.Expr) -> sp.Expr:
            return form_behind(expression, self.control_law, self.system.time, self.initial_time)

        system = equations.system
        begun = replace(
            system,
            kinetic_energy=formed(system.kinetic_energy),
            potential_energy=formed(system.potential_energy),
            forces=tuple(map(formed, system.forces)),
            constraints=tuple(map(formed, system.constraints)),
        )
        return equations if begun == system else replace(equations, system=begun)

    @property
    def initial_time(self) -> sp.Expr:
        """The beginning t0 of the time span, or zero."""
        return exact(self.premises.time_span[0]) if self.premises.time_span else sp.Integer(0)

    @cached_property
    def state(self) -> tuple[sp.Symbol, ...]:
        """Coordinates and velocities."""
        return (*self.system.coordinates, *self.system.velocities)

    @cached_property
    def parameters(self) -> Definitions:
        """The values of the parameters."""
        return {sp.Symbol(x, real=True): exact(y) for x, y in self.premises.parameter_values.items()}

    @cached_property
    def initial_values(self) -> Definitions:
        """The initial state in the record, by its symbols q1_0, dot(q1)_0."""
        return {initial(sp.Symbol(x, real=True)): exact(y) for x, y in self.scene.initial_state.items()}

    @cached_property
    def control_law(self) -> Definitions:
        """Controls and their derivatives as functions of time, by the scene's law.

        It is the one in the record, which `differences` compares with the one that is stated.
        """
        definitions: dict[sp.Symbol, sp.Expr] = {}
        for name, law in self.scene.control_law.items():
            for symbol in history(sp.Symbol(name, real=True)):
                definitions[symbol] = law
                law = law.diff(self.system.time)
        return definitions

    @cached_property
    def controls_at_start(self) -> Definitions:
        """The initial time and the initial controls, u_0, ... for those without a law."""
        without_law = (
            symbol for control in self.system.controls if control not in self.control_law for symbol in history(control)
        )
        return {
            self.system.time: self.initial_time,
            **self.control_law,
            **{symbol: initial(symbol) for symbol in without_law},
        }

    @cached_property
    def start(self) -> Definitions:
        """The initial time, the controls and the state then, in symbols q1_0, dot(q1)_0."""
        return {**self.controls_at_start, **{symbol: initial(symbol) for symbol in self.state}}

    @cached_property
    def configuration(self) -> Definitions:
        """The initial configuration, with the numbers of the scene.

        It holds the time, parameters, controls and coordinates.
        """
        values = {q: self.initial_values.get(initial(q), initial(q)) for q in self.system.coordinates}
        known = {**values, **self.controls_at_start, **self.parameters}
        at_start = {
            symbol: value.xreplace(self.controls_at_start).xreplace(self.parameters) for symbol, value in known.items()
        }
        return {symbol: value for symbol, value in at_start.items() if value.is_number}

    @cached_property
    def given_values(self) -> Definitions:
        """Initial values in the scene, by the symbols q1_0, dot(q1)_0."""
        return {
            initial(sp.Symbol(x, real=True)): exact(y).xreplace(self.parameters)
            for x, y in self.premises.initial_state.items()
        }

    def certificate(self, *solutions: Definitions) -> Definitions | None:
        """Return closed forms of the initial motion in the record, with its multipliers.

        Parameters
        ----------
        *solutions : Definitions
            Further closed forms, by their symbols.

        Returns
        -------
        Definitions or None
            Closed forms by their symbols. None if the record does not hold the multipliers, or those of the beginning.
        """
        multipliers = self.derivation.multipliers()
        if multipliers is None or self.beginning is not self.known:
            return None
        rates = {self.system.rates[symbol]: self.system.time_derivative(value) for symbol, value in multipliers.items()}
        together: dict[sp.Symbol, sp.Expr] = {}
        for solution in (*solutions, multipliers, rates):
            together.update(solution)
        return together


def free_motion_condition(checked: CheckedScene, relations: Relations) -> tuple[Comparison, ...]:
    """Compare (10) under the control law, with every multiplier zero.

    Parameters
    ----------
    checked : CheckedScene
        The scene.
    relations : Relations
        Relations of the equation.

    Returns
    -------
    tuple of Comparison
    """
    expected = checked.known.constraint_accelerations
    derived = list_of("residual", len(expected), relations)
    return (
        Comparison(
            tuple(
                Pair(numbered(translatable("condition of free motion"), beta), value, residual)
                for beta, (value, residual) in enumerate(zip(derived, expected, strict=True), start=1)
            ),
            given=checked.control_law,
            solves=(checked.known.free,),
            certificate=checked.derivation.free_accelerations(),
        ),
    )


def initial_state(checked: CheckedScene, relations: Relations) -> tuple[Comparison, ...]:
    """Compare the initial state (12) with the given values and the constraints.

    The given values may differ by the stated correction. The constraints and their first derivatives vanish there.

    Parameters
    ----------
    checked : CheckedScene
        The scene.
    relations : Relations
        Relations of the equation.

    Returns
    -------
    tuple of Comparison
    """
    names = tuple(map(initial, checked.state))
    derived = solved_for(names, relations)
    if list(checked.scene.initial_state) != [symbol.name for symbol in checked.state]:
        raise NotComparable(translatable("an initial state that is not complete, or not in order"))
    for name in names:
        if derived[name] != checked.initial_values[name]:
            raise NotComparable(translatable("two values of %(name)s"), name=name)
    _require_given(checked, derived)
    pairs = (
        *_vanishing(translatable("constraint"), checked.stated.system.constraints),
        *_vanishing(translatable("derivative of constraint"), checked.stated.constraint_derivatives),
    )
    return at_start(checked, pairs)


def _require_given(checked: CheckedScene, derived: Definitions) -> None:
    """Raise unless initial values are the given ones, up to the stated correction."""
    changes = {}
    for name, value in checked.given_values.items():
        change = (derived[name] - value).xreplace(checked.parameters)
        if change != 0 and (not change.is_number or not change.equals(0)):
            changes[name.name] = _size(change)
    stated = checked.scene.correction
    if not changes and stated is None:
        return
    largest = max(changes, key=changes.get, default=None)
    if largest is None or stated is None or changes.get(stated[0], 0) < changes[largest] * (1 - SAME):
        raise NotComparable(
            translatable("an initial value of %(name)s that is another than the one given"), name=largest or stated[0]
        )
    _require_correction(checked, changes[largest], stated[1])


def _require_correction(checked: CheckedScene, change: mp.mpf, stated: str) -> None:
    """Raise unless a correction is allowed and is the stated one in three digits.

    A correction is allowed for values of limited digits.
    """
    given = max(_size(value.xreplace(checked.parameters)) for value in checked.given_values.values())
    if not abs(change - mp.mpf(stated)) <= mp.mpf(10) ** -STATED_DIGITS * change:
        raise NotComparable(
            translatable("a correction of %(stated)s, where it is %(change)s"), stated=stated, change=mp.nstr(change, 6)
        )
    if change > LIMITED_DIGITS * (given or 1):
        raise NotComparable(translatable("a correction of %(stated)s, which is larger than rounding"), stated=stated)


def _size(number: sp.Expr) -> mp.mpf:
    with mp.workdps(WORKING_DIGITS):
        value = Steps([number]).at({})[0]
        return mp.inf if value is None else abs(value)


def at_start(checked: CheckedScene, pairs: Iterable[Pair]) -> tuple[Comparison, ...]:
    """Return pairs in symbols of the initial state as a comparison with its numbers.

    Parameters
    ----------
    checked : CheckedScene
        The scene.
    pairs : iterable of Pair
        Pairs in symbols of the initial state.

    Returns
    -------
    tuple of Comparison
        One comparison.
    """
    state = {name: value.xreplace(checked.parameters) for name, value in checked.initial_values.items()}
    given = {**checked.parameters, **state, **checked.start}
    pairs = tuple(pairs)
    if not pairs:
        return (Comparison(()),)
    return (Comparison(pairs, given=given, rounded=_rounded(state)),)


def _rounded(values: Definitions) -> Definitions:
    """Return the values that may have been rounded, by their long fractions."""
    longest = 10**FEWEST_ROUNDED_DIGITS
    return {name: x for name, x in values.items() if any(number.q > longest for number in x.atoms(sp.Rational))}


def determined_initial_values(checked: CheckedScene, relations: Relations) -> tuple[Comparison, ...]:
    """Compare (19): determined initial values are present and satisfy the constraints.

    With the values put in, the constraints that determine them vanish identically. A value that is a number, in
    constraints that contain further initial values or parameters, holds for the scene's own numbers only. Each value
    is that of the initial state, for which (12) has the constraints. This also decides the branch of a root.

    Parameters
    ----------
    checked : CheckedScene
        The scene.
    relations : Relations
        Relations of the equation.

    Returns
    -------
    tuple of Comparison
    """
    names = [symbol for symbol in checked.state if initial(symbol) not in checked.given_values]
    lefts = [relation.left_tree for relation in relations]
    ordered = sorted(relations, key=lambda relation: str(relation.left_tree).startswith("dot("))
    if sorted(map(str, lefts)) != sorted(initial(symbol).name for symbol in names) or ordered != list(relations):
        raise NotComparable(
            translatable("values of %(recorded)s where %(expected)s belong"),
            recorded=_listed(map(str, lefts)),
            expected=_listed(initial(x).name for x in names),
        )
    fixed = {sp.Symbol(left, real=True): exact(r.right) for left, r in zip(lefts, relations, strict=True)}
    kinds = (
        (checked.system.coordinates, checked.beginning.system.constraints),
        (checked.system.velocities, checked.beginning.constraint_derivatives),
    )
    residuals = [
        residual
        for symbols, of in kinds
        for residual in _determining(checked, symbols, list(_for_all_states(checked, symbols, of, fixed)), fixed)
    ]
    always = Comparison(
        tuple(_vanishing(translatable("constraint"), residuals)),
        given={**fixed, **checked.start},
        rounded=_rounded(fixed),
    )
    values = (Pair(name.name, fixed[name], name) for name in fixed)
    return always, *at_start(checked, values)


def _for_all_states(
    checked: CheckedScene,
    symbols: Iterable[sp.Symbol],
    residuals: Iterable[sp.Expr],
    fixed: Mapping[sp.Symbol, sp.Expr],
) -> Iterable[sp.Expr]:
    """Return residuals with fixed symbols that hold for all states.

    They contain no symbol that is fixed for the scene's numbers only.
    """
    symbols, residuals = set(symbols), list(residuals)
    known = {symbol for symbol in symbols if initial(symbol) in fixed}
    numbers = {symbol for symbol in known if fixed[initial(symbol)].is_number}
    containing = _containing(known, residuals)
    left_out = checked.scene.left_out
    without = _without_closed_form(numbers, containing, left_out.limit if left_out else inf)
    numbers = {x for x in without if not _has_root(checked, x, known, containing[x])}
    constants = {x for x in checked.state if initial(x) in fixed and fixed[initial(x)].is_number}
    for residual in residuals:
        present = residual.free_symbols & symbols
        others = (present - numbers) | (residual.free_symbols - constants)
        if present & known and not (present & numbers and others):
            yield residual


def _determining(
    checked: CheckedScene, symbols: Iterable[sp.Symbol], residuals: Sequence[sp.Expr], fixed: Definitions
) -> Sequence[sp.Expr]:
    """Return the residuals except conditions on given values.

    Conditions are left where those that vanish identically determine the fixed values. (12) satisfies all of them.
    """
    present = {symbol for residual in residuals for symbol in residual.free_symbols}
    unknown = [symbol for symbol in symbols if symbol in present and initial(symbol) in fixed]
    if len(residuals) <= len(unknown):
        return residuals
    put_in = {r: r.xreplace(checked.control_law).xreplace(checked.start).xreplace(fixed) for r in residuals}
    identities = [residual for residual, value in put_in.items() if is_identically_zero([value])]
    return identities if _rank(checked, identities, unknown) == len(unknown) else residuals


def _rank(checked: CheckedScene, residuals: Sequence[sp.Expr], unknown: Sequence[sp.Symbol]) -> int:
    """Return the number of independent gradients in the initial configuration."""
    gradients = [slope.xreplace(checked.configuration) for r in residuals for slope in gradient(r, unknown)]
    with mp.workdps(WORKING_DIGITS):
        values = Steps(gradients).at({})
        if None in values:
            return 0
        rows = [values[place : place + len(unknown)] for place in range(0, len(values), len(unknown))]
        return Elimination([{k: x for k, x in enumerate(row) if x != 0} for row in rows]).rank


def _containing(symbols: set[sp.Symbol], residuals: Iterable[sp.Expr]) -> Mapping[sp.Symbol, list[sp.Expr]]:
    """Return the residuals that contain each symbol."""
    found: dict[sp.Symbol, list[sp.Expr]] = defaultdict(list)
    for residual in residuals:
        for symbol in residual.free_symbols & symbols:
            found[symbol].append(residual)
    return found


def _without_closed_form(
    numbers: set[sp.Symbol], containing: Mapping[sp.Symbol, Sequence[sp.Expr]], limit: float
) -> set[sp.Symbol]:
    """Return the symbols that have no closed form.

    They share residuals with many symbols, or with one that is not linear in them. Or the residuals are more than the
    symbols: those that a closed form is made of may depend on each other in the initial state. Or the closed form may
    be larger than what the record leaves out.
    """
    found: set[sp.Symbol] = set()
    waiting = set(numbers)
    while waiting:
        sharing = _sharing(next(iter(waiting)), numbers, containing)
        waiting -= sharing
        residuals = {residual for x in sharing for residual in containing[x]}
        linear = not any(residual.diff(x).free_symbols & numbers for x in sharing for residual in residuals)
        length = sum(1 for residual in residuals for _ in sp.preorder_traversal(residual))
        if len(sharing) >= MANY_TOGETHER or len(residuals) > len(sharing) or not linear or SHORTENED * length > limit:
            found |= sharing
    return found


def _sharing(
    x: sp.Symbol, numbers: set[sp.Symbol], containing: Mapping[sp.Symbol, Sequence[sp.Expr]]
) -> set[sp.Symbol]:
    """Return the symbols that share residuals with one, directly or through others."""
    found: set[sp.Symbol] = set()
    waiting = [x]
    while waiting:
        y = waiting.pop()
        if y not in found:
            found.add(y)
            waiting += [z for residual in containing[y] for z in residual.free_symbols & numbers]
    return found


def _has_root(checked: CheckedScene, x: sp.Symbol, known: set[sp.Symbol], containing: Sequence[sp.Expr]) -> bool:
    """Return True if one residual fixes a symbol by a linear or quadratic equation."""
    if len(containing) != 1 or containing[0].free_symbols & known != {x}:
        return False
    state = {*checked.state, checked.system.time}
    numbers = {u for u, law in checked.control_law.items() if law.free_symbols <= {checked.system.time}}
    if not containing[0].free_symbols <= state | numbers:
        return False
    polynomial = containing[0].as_poly(*containing[0].free_symbols)
    return polynomial is not None and polynomial.degree(x) in (1, 2)


def _listed(names: Iterable[str]) -> str:
    return ", ".join(sorted(names)) or "nothing"


def initial_accelerations(checked: CheckedScene, relations: Relations) -> tuple[Comparison, ...]:
    """Compare (13), the accelerations of the bordered system at the initial time.

    Parameters
    ----------
    checked : CheckedScene
        The scene.
    relations : Relations
        Relations of the equation.

    Returns
    -------
    tuple of Comparison
    """
    system = checked.system
    derived = _by_initial_values(checked, [initial(a) for a in system.accelerations], relations)
    solution = {a: derived[initial(a)] for a in system.accelerations}
    return (
        Comparison(
            tuple(Pair(initial(a).name, value, a) for a, value in solution.items()),
            given=checked.start,
            solves=(checked.beginning.bordered,),
            certificate=checked.certificate(solution),
        ),
    )


def initial_series(checked: CheckedScene, relations: Relations) -> tuple[Comparison, ...]:
    """Compare (18): the series is that of the motion to the third order.

    Its fourth derivative is zero.

    Parameters
    ----------
    checked : CheckedScene
        The scene.
    relations : Relations
        Relations of the equation.

    Returns
    -------
    tuple of Comparison
    """
    system = checked.system
    derived = _by_initial_values(checked, system.coordinates, relations)
    rates: dict[sp.Symbol, sp.Expr] = {}
    pairs = []
    for q, series in derived.items():
        for symbol in history(q):
            rates[symbol] = series.xreplace({system.time: checked.initial_time})
            pairs.append(Pair(initial(symbol).name, rates[symbol], symbol))
            series = series.diff(system.time)
        pairs.append(Pair(translatable("remainder of the series of %(name)s", name=str(q)), series, sp.Integer(0)))
    highest = {x: rates[x] for x in (*system.accelerations, *system.jerks)}
    return (
        Comparison(
            tuple(pairs),
            given=checked.start,
            solves=(checked.beginning.bordered, checked.beginning.bordered_derivatives),
            certificate=checked.certificate(highest),
        ),
    )


def _by_initial_values(checked: CheckedScene, symbols: Sequence[sp.Symbol], relations: Relations) -> Definitions:
    """Return right sides, in which the state is that at the initial time."""
    derived = solved_for(symbols, relations)
    moving = set().union(*(each.free_symbols for each in derived.values())) & {*checked.state}
    for name in sorted(map(str, moving)):
        raise NotComparable(translatable("%(name)s, which changes, in place of its initial value"), name=name)
    return derived


def _vanishing(what: str, expressions: Iterable[sp.Expr]) -> Iterable[Pair]:
    for i, expression in enumerate(expressions, start=1):
        yield Pair(numbered(what, i), sp.Integer(0), expression)


COMPARISONS = {
    "free_motion_residual": free_motion_condition,
    "initial_state": initial_state,
    "initial_accelerations": initial_accelerations,
    "initial_series": initial_series,
    "determined_initial_values": determined_initial_values,
}
"""The comparison that decides each equation of a scene, by its id."""
