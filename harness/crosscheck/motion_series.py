"""Verdicts on power series of a motion: they must satisfy the equations of motion.

Controls of servo-constraints are checked as well: the motion program with these controls is expanded, and along that
motion the outputs must stay zero.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from mpmath import mp

from ..description import Description
from ..failures import HolonomError
from ..formats import Document, read
from ..number_texts import number, numbers
from ..program.motion_problem import MotionProblem
from ..program.request import Solve
from ..series.power_series import MotionSeries, SeriesDocument
from ..series.request import EXACT
from .compared_values import differing
from .described_motion import DescribedMotion, Residual
from .digits import DIGITS
from .irregular_point import IrregularPoint
from .motion_program import OF_SPECIAL_FUNCTIONS, ProgramVerdict, ScenePrograms, why_missing
from .motion_start import values_of_start
from .motion_states import ComparedValue
from .program_values import Values, run_along, symbols_of_tables, with_signs
from .questions import ORDER, Answer, holds_special_functions
from .ranks import Elimination
from .report import CheckResult, Verdict
from .taylor import Polynomial, Taylor

PERTURBATIONS = 3  # of all coefficients, by which the effect of rounding them is found
DIGITS_OF = {"double": 15, "extended": 18, "quadruple": 33}
SMALL_STEP = mp.mpf(2) ** -20  # of the largest acceleration
LOST = 8  # digits that a rounded coefficient may lose on its way into the equations
Complete = Callable[[Values, list[Polynomial]], Values]  # the series with the powers that follow from them
SERIES, SERVO = "power series", "servo-constraints, along the motion"


@dataclass(frozen=True)
class SceneSeries:
    """The power series of one scene, or the reason for none."""

    scene: str
    series: MotionSeries | None
    missing: CheckResult | None = None


def read_all_series(description: Description, answers: Mapping[str, Answer]) -> list[SceneSeries]:
    """Read Maxima's answers about power series.

    Parameters
    ----------
    description : Description
        The reference.
    answers : mapping of str to Answer
        Document or error for each scene.

    Returns
    -------
    list of SceneSeries
        One for each scene.

    Raises
    ------
    HolonomError
        An answer is not a document of the expected form.
    """
    return [_series_of(description, scene.name, answers.get(scene.name)) for scene in description.scenes]


def _series_of(description: Description, scene: str, answer: Answer | None) -> SceneSeries:
    if isinstance(answer, str):
        return SceneSeries(scene, read(Document.MOTION_SERIES, answer, MotionSeries))
    if isinstance(answer, HolonomError):
        return SceneSeries(scene, None, why_missing(answer))
    if holds_special_functions(description):
        return SceneSeries(scene, None, OF_SPECIAL_FUNCTIONS)
    reason = f"no power series of {len(description.system.coordinates)} coordinates is asked for"
    return SceneSeries(scene, None, CheckResult(Verdict.NOTHING, None, None, reason))


def verify_series(
    description: Description, found: Iterable[SceneSeries], programs: Iterable[ScenePrograms] = ()
) -> list[ProgramVerdict]:
    """Return verdicts on the power series of the scenes of a description.

    The programs of the same scenes state the corrections of given values.

    Parameters
    ----------
    description : Description
        The reference.
    found : iterable of SceneSeries
        Power series of its scenes.
    programs : iterable of ScenePrograms
        Programs of the same scenes.

    Returns
    -------
    list of ProgramVerdict
        One for each scene without servo-constraints.
    """
    scenes = {scene.name: scene for scene in description.scenes}
    corrections = {each.scene: problem.initial.correction for each in programs for problem in each.problems.values()}
    verdicts = []
    for each in found:
        if scenes[each.scene].servo_trees:
            continue  # the series does not hold the controls: `verify_servo` looks at it
        if each.series is None:
            result = each.missing
        else:
            motion = DescribedMotion(description, scenes[each.scene])
            series, digits = each.series, digits_of(each.series.arithmetic, LOST)
            result = _verify(partial(compared_series, motion, series, corrections.get(each.scene)), digits)
        verdicts.append(ProgramVerdict(each.scene, SERIES, result))
    return verdicts


def verify_servo(
    description: Description, programs: Iterable[ScenePrograms], found: Iterable[SceneSeries]
) -> list[ProgramVerdict]:
    """Return verdicts on controls of servo-constraints and on their power series.

    Parameters
    ----------
    description : Description
        The reference.
    programs : iterable of ScenePrograms
        Programs of its scenes.
    found : iterable of SceneSeries
        Power series of its scenes.

    Returns
    -------
    list of ProgramVerdict
        One for each scene with servo-constraints.
    """
    verdicts, series = [], {each.scene: each.series for each in found}
    for each in programs:
        scene = next((scene for scene in description.scenes if scene.name == each.scene), None)
        problem = each.problems.get(Solve.DIRECT)
        if scene is not None and scene.servo_trees and problem is not None and problem.motion is not None:
            motion = DescribedMotion(description, scene)
            own = series.get(each.scene)
            compared = partial(_values_of_servo, motion, problem, own)
            result = _verify(compared, DIGITS if own is None else digits_of(own.arithmetic, LOST))
            verdicts.append(ProgramVerdict(each.scene, SERVO, result))
    return verdicts


def digits_of(arithmetic: str, lost: int) -> int:
    """Return the digits in which a series has to satisfy the equations.

    Parameters
    ----------
    arithmetic : str
        As of `SeriesDocument`.
    lost : int
        Digits that a rounded coefficient may lose.

    Returns
    -------
    int
    """
    if arithmetic == EXACT:
        return DIGITS
    stated = arithmetic.partition("(")[2].rstrip(")")
    return min(DIGITS, (int(stated) if stated else DIGITS_OF[arithmetic]) - lost)


def _verify(compared: Callable[[], Iterator[ComparedValue]], digits: int) -> CheckResult:
    try:
        wrong = differing(compared, digits)
    except IrregularPoint:
        reason = "the equations of motion have no power series at the initial time"
        return CheckResult(Verdict.NOTHING, None, None, reason)
    return CheckResult(Verdict.DISAGREES if wrong else Verdict.AGREES, digits, 1, wrong)


def compared_series(
    motion: DescribedMotion,
    series: MotionSeries | SeriesDocument,
    correction: tuple[str, str] | None,
    order: int = ORDER,
) -> Iterator[ComparedValue]:
    """Check that a power series starts at the initial state and is a solution.

    Prescribed reactions are among the equations.

    Parameters
    ----------
    motion : DescribedMotion
        The reference.
    series : MotionSeries or SeriesDocument
    correction : tuple of str and str or None
        As for `values_of_start`.
    order : int
        Order of the series.

    Yields
    ------
    ComparedValue
    """
    taylor, time = Taylor(order), motion.first_time  # which the series has rounded
    curve: Values = motion.all_parameters() | motion.law.at(Taylor(order + 3), time, motion.parameters())
    curve |= {name: tuple(numbers(row)) for name, row in series.coordinates.items()}
    curve["t"] = (time, mp.one)
    multipliers = {name: tuple(numbers(row)) for name, row in series.multipliers.items()}
    for name, prescribed in motion.reactions.at(taylor, time, motion.parameters()).items():
        for k in range(order + 1):
            true = _coefficient(prescribed, k)
            yield ComparedValue(f"coefficient {k} of {name}", _coefficient(multipliers[name], k), true, abs(true))
    yield from _values_of_rows(series.controls, curve, mp.zero)
    yield from values_of_start(motion, _start(series), correction)
    ordered = [multipliers[name] for name in motion.system.multipliers]
    yield from _values_of_forces(motion, taylor, curve, ordered, series.constraint_forces)
    yield from values_of_series(motion, curve, tuple(series.coordinates), ordered, order)


def _values_of_forces(
    motion: DescribedMotion,
    taylor: Taylor,
    curve: Values,
    multipliers: list[Polynomial],
    given: Mapping[str, Sequence[str]],
) -> Iterator[ComparedValue]:
    """Yield the constraint forces of a series, by Lambda[s]."""
    if not given:
        return

    def forces(curve: Values, multipliers: list[Polynomial]) -> list[Polynomial]:
        found = motion.constraint_forces(taylor, motion.values(taylor, curve), multipliers)
        return [found.get(q, (mp.zero,)) for q in motion.system.coordinates]

    true = forces(curve, multipliers)
    changes = _changes(motion, taylor.order, curve, multipliers, true, forces)
    for name, row in given.items():
        s = int(name.removeprefix("Lambda[").removesuffix("]")) - 1
        for k, x in enumerate(numbers(row)):
            yield ComparedValue(f"coefficient {k} of {name}", x, _coefficient(true[s], k), changes[s][k])


def _start(series: MotionSeries) -> dict[str, mp.mpf]:
    found = {"t": number(series.t0)}
    for name, row in series.coordinates.items():
        found[name], found[f"dot({name})"] = numbers(row[:2])
    return found


def values_of_series(
    motion: DescribedMotion, curve: Values, names: Sequence[str], multipliers: list[Polynomial], order: int
) -> Iterator[ComparedValue]:
    """Check that power series of rounded coefficients satisfy all equations.

    The two powers of the coordinates that follow from the multipliers are disturbed as these are: their rounding is
    among the sizes that the residuals are compared with.

    Parameters
    ----------
    motion : DescribedMotion
        The reference.
    curve : Values
        Series of the time, parameters, controls and coordinates.
    names : sequence of str
        Coordinates, those of the system first. `curve` has their coefficients up to the order.
    multipliers : list of Polynomial
        Series of the multipliers, in order.
    order : int
        Order of the series.

    Yields
    ------
    ComparedValue
        Coefficient of a residual.
    """

    def whole(curve: Values, multipliers: list[Polynomial]) -> Values:
        return curve | _continued(motion, curve, names, multipliers, order)

    yield from _values_of_equations(motion, Taylor(order + 2), curve, multipliers, whole)


def _continued(
    motion: DescribedMotion, curve: Values, names: Sequence[str], multipliers: list[Polynomial], order: int
) -> Values:
    """Return series with the two powers that follow from the multipliers.

    With A and J at the initial time they satisfy A x = r and J x = s, where r contains the last coefficients of the
    multipliers. The solution of (A + w J^T J) x = r + w J^T s satisfies both only if these are right.
    """
    rows = {name: tuple(curve[name][: order + 1]) for name in names}
    columns = _slopes(motion, curve, rows, multipliers)
    n = len(motion.system.coordinates)
    weight = _largest(column[:n] for column in columns) / (_largest(column[n:] for column in columns) ** 2 or 1)

    def combined(x: Sequence[mp.mpf]) -> list[mp.mpf]:
        reactions = [mp.fsum(j * s for j, s in zip(column[n:], x[n:], strict=True)) for column in columns]
        return [(x[i] if i < n else mp.zero) + weight * reaction for i, reaction in enumerate(reactions)]

    matrix = list(zip(*map(combined, columns), strict=True))
    equations = [{j: x for j, x in enumerate(row) if x} for row in matrix]
    for k in (order - 1, order):
        left = _residuals_at(motion, curve | rows, multipliers, k)
        accelerations = mp.mpf(k + 2) * (k + 1) / 2
        left = [*(x / accelerations for x in left[:n]), *left[n:]]
        found = Elimination(equations, [-x for x in combined(left)]).solution()
        rows = {name: (*row, found.get(i, mp.zero)) for i, (name, row) in enumerate(rows.items())}
    return rows


def _slopes(motion: DescribedMotion, curve: Values, rows: Values, multipliers: list[Polynomial]) -> list[list[mp.mpf]]:
    """Return the columns of 2 A and J at the initial time, one below the other.

    The equations are linear in the accelerations. A step as large as these changes signs of what begins to move, and
    a much smaller one is rounded away.
    """
    before = _residuals_at(motion, curve, multipliers, 0)
    step = SMALL_STEP * (max((abs(row[2]) for row in rows.values()), default=mp.zero) or mp.one)
    moved = ({name: (*row[:2], row[2] + step)} for name, row in rows.items())
    after = (_residuals_at(motion, curve | each, multipliers, 0) for each in moved)
    return [[(x - y) / step for x, y in zip(each, before, strict=True)] for each in after]


def _residuals_at(motion: DescribedMotion, curve: Values, multipliers: list[Polynomial], k: int) -> list[mp.mpf]:
    """Return power k of the equations of motion, then power k + 2 of the constraints."""
    taylor = Taylor(k + 2)
    values = motion.values(taylor, curve)
    left = [_coefficient(each.value, k) for each in motion.equations(taylor, values, multipliers)]
    return left + [_coefficient(values[place], k + 2) for place in motion.constraints]


def _largest(columns: Iterable[Sequence[mp.mpf]]) -> mp.mpf:
    return max((abs(x) for column in columns for x in column), default=mp.zero)


def _values_of_equations(
    motion: DescribedMotion, taylor: Taylor, curve: Values, multipliers: list[Polynomial], whole: Complete
) -> Iterator[ComparedValue]:
    """Check that power series satisfy the equations of motion and all constraints."""
    places = [*motion.constraints, *motion.outputs]
    needed = motion.tape.needed_for(places)

    def residuals(curve: Values, multipliers: list[Polynomial]) -> list[Residual]:
        values = motion.values(taylor, whole(curve, multipliers))
        sizes = motion.tape.sizes(taylor, values, needed)
        left = [Residual(values[place], sizes[place]) for place in places]
        return motion.equations(taylor, values, multipliers) + left

    found = residuals(curve, multipliers)
    before = [each.value for each in found]
    changes = _changes(
        motion, taylor.order, curve, multipliers, before, lambda *at: [each.value for each in residuals(*at)]
    )
    for (name, last), residual, change in zip(_named(motion, taylor.order), found, changes, strict=True):
        for k in range(last + 1):
            size = max(_coefficient(residual.size, k), change[k])
            yield ComparedValue(f"power {k} of {name}", _coefficient(residual.value, k), mp.zero, size)


def _named(motion: DescribedMotion, order: int) -> Iterator[tuple[str, int]]:
    """Yield names of the equations and constraints, and the last powers that count."""
    yield from ((f"the equation of motion of {q}", order - 2) for q in motion.system.coordinates)
    for what, places in (("constraint", motion.constraints), ("servo-constraint", motion.outputs)):
        yield from ((f"{what} {beta}", order) for beta in range(1, len(places) + 1))


def _changes(
    motion: DescribedMotion,
    order: int,
    curve: Values,
    multipliers: list[Polynomial],
    before: Sequence[Polynomial],
    made: Callable[[Values, list[Polynomial]], list[Polynomial]],
) -> list[list[mp.mpf]]:
    """Return the sensitivity of results to relative changes of all coefficients.

    The coefficients are rounded, and so may the initial time be.
    """
    found = [[mp.zero] * (order + 1) for _ in before]
    share = mp.mpf(10) ** (-mp.dps // 3)
    for attempt in range(PERTURBATIONS):
        draw = random.Random(attempt)

        def moved(row: Polynomial, draw: random.Random = draw) -> Polynomial:
            return tuple(x * (1 + share * draw.choice((-1, 1)) * (1 + draw.random())) for x in row)

        changed = curve | {q: moved(curve[q]) for q in (*motion.system.coordinates, *motion.freed)}
        changed["t"] = (*moved(curve["t"][:1]), *curve["t"][1:])
        after = made(changed, list(map(moved, multipliers)))
        for own, *both in zip(found, before, after, strict=True):
            for k in range(order + 1):
                old, new = (_coefficient(each, k) for each in both)
                own[k] = max(own[k], abs(new - old) / share)
    return found


def _values_of_servo(
    motion: DescribedMotion, problem: MotionProblem, series: MotionSeries | None
) -> Iterator[ComparedValue]:
    """Check that the outputs stay zero along the program's motion.

    That motion is also the one of the power series, with its multipliers and controls.
    """
    taylor = Taylor(ORDER)
    curve, computed = _expanded(problem)
    found = {name: computed[name] for name in motion.system.controls if name in computed}
    law = motion.law.at(Taylor(ORDER + 1), curve["t"][0], motion.parameters())
    if series:
        reactions = {name: computed[name] for name in problem.reactions}
        yield from _values_of_rows(series.coordinates, curve, mp.zero)
        largest = max((mp.fsum(map(abs, row)) for row in (*reactions.values(), *found.values())), default=mp.zero)
        yield from _values_of_rows(series.multipliers, reactions, largest)
        yield from _values_of_rows(series.controls, law | computed, largest)
    multipliers = [computed[name] for name in motion.system.multipliers]
    curve = motion.all_parameters() | found | law | curve
    yield from _values_of_forces(motion, taylor, curve, multipliers, series.constraint_forces if series else {})
    yield from _values_of_equations(motion, taylor, curve, multipliers, lambda curve, _: curve)


def _values_of_rows(rows: Mapping[str, Sequence[str]], true: Values, largest: mp.mpf) -> Iterator[ComparedValue]:
    """Yield the coefficients of a series with the true ones.

    Rounding disturbs each by a share of the largest of the quantities that it is found with.
    """
    for name, row in rows.items():
        size = max(mp.fsum(map(abs, true[name])), largest * mp.mpf(10) ** -LOST)
        for k, x in enumerate(numbers(row)):
            yield ComparedValue(f"power {k} of {name}", x, _coefficient(true[name], k), size)


def _expanded(problem: MotionProblem) -> tuple[Values, Values]:
    """Return power series of the coordinates and of the program's results.

    They follow from its accelerations, from the initial state on. Those of the results end at the same order as the
    multipliers of a series, so that the coordinates have two more powers.
    """
    start = {name: mp.mpf(text) for name, text in problem.start.items()}
    known = {q: (start[q], start[f"dot({q})"]) for q in problem.coordinates}
    fixed = dict.fromkeys(problem.multipliers, (mp.zero,)) | symbols_of_tables(problem, start["t"])
    fixed = with_signs(problem, fixed | {name: (x,) for name, x in start.items()})
    computed: Values = {}
    for order in range(ORDER + 1):
        taylor = Taylor(order)
        state = {"t": (start["t"], mp.one)} | known | {f"dot({q})": taylor.rate(x) for q, x in known.items()}
        computed = run_along(problem.motion, fixed | {name: x[: order + 1] for name, x in state.items()}, taylor)
        for q, x in known.items():
            known[q] = (*x, _coefficient(computed[f"ddot({q})"], order) / ((order + 1) * (order + 2)))
    return known | {"t": (start["t"], mp.one)}, computed


def _coefficient(x: Polynomial, k: int) -> mp.mpf:
    return x[k] if k < len(x) else mp.zero
