"""The initial state of a motion, compared with the description alone.

Values that a scene leaves out are the nearest to its guess, by Newton's method with the shortest corrections in the
mass metric (eqs. (12), (19)). The method is repeated here. An initial state is wrong if the method finds a nearer
one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from mpmath import mp

from ..language import translatable
from .described_motion import DescribedMotion
from .irregular_point import IrregularPoint
from .motion_states import ComparedValue
from .ranks import Elimination, Row
from .taylor import Polynomial, Taylor

State = Mapping[str, mp.mpf]
VALUE, RATE = Taylor(0), Taylor(1)
FLAT = Taylor(7)  # of the law, whose parts may meet at the initial time by a function with vanishing derivatives
START_DIGITS = 45  # to which constraints hold at an initial state
NEWTON_STEPS, HALVINGS = 60, 20
CONVERGED = 20  # digits of a root that is only compared by its distance
NEARER = (
    mp.mpf(9) / 10
)  # share of a distance on a manifold, where the shortest corrections do not find the nearest point
NEARER_ROOT = 1 - mp.mpf(10) ** -6  # the same of isolated roots
FAINT = mp.mpf(10) ** -20  # share of the metric that coordinates without mass have


def values_of_start(
    motion: DescribedMotion, start: State, correction: tuple[str, str] | None
) -> Iterator[ComparedValue]:
    """Compare an initial state with the given values and the constraints.

    The constraints and their first derivatives must vanish.

    Parameters
    ----------
    motion : DescribedMotion
        The scene.
    start : mapping of str to mpf
        The time, coordinates and velocities.
    correction : tuple of str and str or None
        The given value with the largest reported correction, and that correction.

    Yields
    ------
    ComparedValue
        Of a value, a constraint or its derivative.
    """
    yield ComparedValue("first time", start["t"], motion.first_time, abs(motion.first_time))
    allowed = mp.mpf(correction[1]) * mp.mpf("1.01") if correction else mp.zero
    for name, tree in motion.scene.initial_state.trees.items():
        given = motion.number_of(tree)
        near = abs(start[name] - given) <= allowed
        yield ComparedValue(f"initial value of {name}", start[name], start[name] if near else given, abs(given))
    # forces may have no value at the initial time
    needed = motion.tape.needed_for([*motion.constraints, *motion.outputs])
    curve = _curve(motion, start)
    values = motion.values(RATE, curve, needed)
    sizes = motion.tape.sizes(RATE, values, needed)
    for what, places in (("constraint", motion.constraints), ("servo-constraint", motion.outputs)):
        for beta, place in enumerate(places, 1):
            slopes = motion.tape.gradient(RATE, values, {place: (mp.one,)})
            for order, prefix in enumerate(("", "derivative of ")):
                value, size = ((*each[place], mp.zero)[order] for each in (values, sizes))
                changes = (_changes(motion, slopes, start, curve, name)[order] for name in slopes)
                size += mp.fsum(abs(x) for each in changes for x in each)
                yield ComparedValue(f"{prefix}{what} {beta} at the initial time", value, mp.zero, size)


def _changes(
    motion: DescribedMotion, slopes: Mapping[str, Polynomial], start: State, curve: Mapping[str, Polynomial], name: str
) -> tuple[list[mp.mpf], list[mp.mpf]]:
    """Return changes of a constraint, and of its derivative, by relative changes.

    A coordinate and its velocity change, or the time and with it the controls.
    """
    slope, slope_rate = (*slopes[name], mp.zero)[:2]
    if name in motion.system.coordinates:
        x, rate = start.get(name, mp.zero), start.get(f"dot({name})", mp.zero)
        return [slope * x], [slope * rate, slope_rate * x]
    _, rate, half = (*curve.get(name, ()), mp.zero, mp.zero, mp.zero)[:3]
    x, bend = start["t"] * rate, 2 * start["t"] * half
    return [slope * x], [slope * bend, slope_rate * x]


def nearer_start(motion: DescribedMotion, start: State, masses: State | None = None) -> str:
    """Return a value that Newton's method finds nearer to the guess, empty if none.

    Parameters
    ----------
    motion : DescribedMotion
        The scene.
    start : State
        Time, coordinates and velocities of the initial state.
    masses : State or None
        Masses of the moving controls in the problem, or None for none.

    Returns
    -------
    str
        Message that names the value.
    """
    if motion.scene is None or not motion.scene.initial_guess:
        return ""
    guessed = {name: motion.number_of(tree) for name, tree in motion.scene.initial_guess.trees.items()}
    guess = {name: value for name, value in guessed.items() if name not in motion.scene.initial_state}
    coordinates = (*motion.system.coordinates, *motion.moved)
    places = {q: q for q in coordinates}
    rates = {f"dot({q})": q for q in coordinates}
    for order, columns in enumerate((places, rates)):
        own = {name: guess[name] for name in columns if name in guess}
        if own and (found := _Search(motion, start, own, columns, order, masses or {}).nearer()):
            return found
    return ""


def _curve(motion: DescribedMotion, state: State) -> dict[str, Polynomial]:
    time = motion.first_time  # which a document has rounded
    law = motion.law.at(FLAT, time, motion.parameters())
    places = {q: (state[q], rate) for q in state if (rate := state.get(f"dot({q})")) is not None}
    forcing = dict.fromkeys(
        motion.system.controls if motion.scene.servo_trees else (), (mp.zero,)
    )  # not in constraints
    forcing |= dict.fromkeys(motion.reacting, (mp.one,))
    return motion.all_parameters() | forcing | law | places | {"t": (time, mp.one)}


class _Search:
    """Newton's method from a guess, by the shortest corrections.

    The unknowns are coordinates (order 0) or velocities (order 1).
    """

    def __init__(
        self,
        motion: DescribedMotion,
        start: State,
        guess: State,
        columns: Mapping[str, str],
        order: int,
        masses: State,
    ) -> None:
        self._masses = masses
        self._motion, self._start, self._guess, self._order = motion, start, guess, order
        self._columns = {columns[name]: i for i, name in enumerate(guess)}  # place of each coordinate among the names
        self._conditions = [*motion.constraints, *motion.outputs]

    def nearer(self) -> str:
        """Return a value of a root nearer than the initial state, empty if none is found."""
        try:
            guess = {**self._start, **self._guess}
            metric = self._metric(guess)
            found, is_open = self._root(guess, metric)
            if is_open and self._motion.scene.servo_trees:  # time derivatives of the outputs are conditions as well
                return ""
            ways = [[state[name] - at for name, at in self._guess.items()] for state in (found, self._start)]
            own, other = (_length(metric, way) for way in ways)
        except (IrregularPoint, ZeroDivisionError, OverflowError):
            return ""
        if own >= (NEARER if is_open else NEARER_ROOT) * other or self._is_same(found):
            return ""
        name = max(self._guess, key=lambda name: abs(found[name] - self._start[name]))
        given, true = mp.nstr(self._start[name], 12), mp.nstr(found[name], 12)
        return translatable(
            "initial value of %(name)s: %(given)s, where %(true)s is nearer to the guess",
            name=name,
            given=given,
            true=true,
        )

    def _is_same(self, found: State) -> bool:
        """Return True if a root is the initial state, to the digits that it has."""
        return max(abs(found[name] - self._start[name]) for name in self._guess) <= _step_of_root(found)

    def _metric(self, state: State) -> list[Row]:
        """Return the mass matrix of the names at a state.

        Coordinates without mass get a small one.
        """
        motion, rates = self._motion, [f"dot({q})" for q in self._columns]
        at_rest = state | {f"dot({q})": mp.zero for q in motion.system.coordinates if q in state}
        momenta = [
            motion.momenta(VALUE, motion.values(VALUE, _curve(motion, each)))
            for each in (at_rest, *({**at_rest, rate: mp.one} for rate in rates))
        ]
        resting, *moving = ([each.get(rate, (mp.zero,))[0] for rate in rates] for each in momenta)
        rows = [{k: a - b for k, (a, b) in enumerate(zip(row, resting, strict=True)) if a != b} for row in moving]
        faint = FAINT * (max((abs(x) for row in rows for x in row.values()), default=mp.zero) or 1)
        own = {i: self._masses[q] for q, i in self._columns.items() if q in self._masses}
        return [row | {i: row.get(i, mp.zero) + own.get(i, faint)} for i, row in enumerate(rows)]

    def _root(self, state: State, metric: Sequence[Row]) -> tuple[State, bool]:
        """Return the root found, and True if it belongs to a continuum.

        Raises
        ------
        IrregularPoint
            The method does not converge.
        """
        left, rows = self._residuals(state)
        for _ in range(NEWTON_STEPS):
            step = _shortest(metric, rows, left)
            if max(map(abs, step), default=mp.zero) <= _step_of_root(state):
                return state, Elimination(rows).rank < len(metric)
            state, left, rows = self._damped(state, step, left)
        raise IrregularPoint

    def _damped(self, state: State, step: Sequence[mp.mpf], left: Sequence[mp.mpf]) -> tuple:
        """Return the state after a step, halved until the residuals decrease.

        Their values and slopes are returned as well.
        """
        for halving in range(HALVINGS):
            share = mp.mpf(2) ** -halving
            moved = state | {name: state[name] - share * by for name, by in zip(self._guess, step, strict=True)}
            try:
                found, rows = self._residuals(moved)
            except (IrregularPoint, ZeroDivisionError, OverflowError):
                continue
            if mp.norm(found) < mp.norm(left) or not any(left):
                return moved, found, rows
        raise IrregularPoint

    def _residuals(self, state: State) -> tuple[list[mp.mpf], list[Row]]:
        """Return the residuals, and their slopes by the names."""
        tape, order = self._motion.tape, Taylor(self._order)
        values = self._motion.values(order, _curve(self._motion, state))
        left = [(*values[place], mp.zero)[self._order] for place in self._conditions]
        slopes = [tape.gradient(order, values, {place: (mp.one,)}) for place in self._conditions]
        rows = [{i: slope[q][0] for q, i in self._columns.items() if q in slope and slope[q][0]} for slope in slopes]
        return left, rows


def _step_of_root(state: State) -> mp.mpf:
    """Return the largest step of Newton's method that counts as none."""
    return mp.mpf(10) ** -CONVERGED * max(map(abs, state.values()))


def _shortest(metric: Sequence[Row], rows: Sequence[Row], left: Sequence[mp.mpf]) -> list[mp.mpf]:
    """Solve J x = f by the x that is shortest in the metric: A x + J^T y = 0."""
    n = len(metric)
    bordered = [dict(row) for row in metric]
    for beta, row in enumerate(rows):
        for k, x in row.items():
            bordered[k][n + beta] = x
    solution = Elimination([*bordered, *rows], [*[mp.zero] * n, *left]).solution()
    return [solution.get(k, mp.zero) for k in range(n)]


def _length(metric: Sequence[Row], way: Sequence[mp.mpf]) -> mp.mpf:
    """Return the length of a displacement in the metric."""
    return mp.sqrt(max(mp.fsum(way[i] * a * way[k] for i, row in enumerate(metric) for k, a in row.items()), mp.zero))
