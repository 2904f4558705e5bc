"""The test set of hard cases: their motions, and the digits of each method.

The reference values are in ``references.json``. The tests compute them by other means: closed forms, quadratures,
published values, and solutions with many digits.
"""

import json
from collections.abc import Callable, Iterator
from functools import partial
from math import nan
from pathlib import Path

import numpy as np

from ...failures import ErrorKind, HolonomError
from ...language import translatable
from ...simulation.hard_cases import Difficulty
from .case import (
    Case,
    CaseReport,
    Extent,
    Findings,
    Sweep,
    correct_digits,
    digits_of_error,
    examined,
    graded,
    required,
)
from .runs import BASELINE, baseline_motion, place_digits, problem, simulated
from .solves import TEXTBOOK, every_solve, solve_digits

REFERENCES = json.loads(Path(__file__).with_name("references.json").read_text("utf-8"))
ANGLES = tuple(10.0**-k for k in range(1, 12))  # between the rods, of length 1: the hinges are as far apart
COMPARED_ANGLE = 1e-7


def _parallel_constraints(extent: Extent) -> Findings:
    """Compare accelerations of a swing, whose rods leave a pendulum's circle free."""
    truth = REFERENCES["parallel_constraints"]
    digits = {
        name: tuple(min(_acceleration_digits(truth, partial(solve, angle))) for angle in ANGLES)
        for name, solve in every_solve("hard/swing.mac").items()
    }
    there = {name: row[ANGLES.index(COMPARED_ANGLE)] for name, row in digits.items()}
    yield from solve_digits(
        translatable("accelerations at the angle %(angle)g", angle=COMPARED_ANGLE), there, needed=8.0
    )
    yield Sweep(translatable("angle between the constraints"), ANGLES, digits)


def _acceleration_digits(truth: dict, solve: Callable) -> Iterator[float]:
    for state, accelerations in zip(truth["states"], truth["accelerations"], strict=True):
        yield correct_digits(solve(np.array(state)).accelerations, accelerations)


def _redundant(file: str, needed: float, truth: dict) -> Findings:
    """Compare a motion with redundant constraints, whose multipliers are zero."""
    motion, baseline = simulated(problem(file), truth["until"]), baseline_motion(problem(file), truth["until"])
    yield from place_digits(translatable("coordinates"), baseline, motion, truth["coordinates"], needed)
    for quantity, computed in (
        (translatable("constraint forces"), motion.constraint_forces),
        (translatable("multipliers"), motion.multipliers),
    ):
        yield graded(motion.engine, quantity, correct_digits(computed, truth[quantity]), needed)
    yield required(motion.engine, translatable("redundancy reported"), Difficulty.REDUNDANT in motion.cases)


def _constraint_given_twice(extent: Extent) -> Findings:
    return _redundant("hard/repeated_constraint.mac", 10.0, REFERENCES["constraint_given_twice"])


def _sarrus_linkage(extent: Extent) -> Findings:
    return _redundant("hard/sarrus_linkage.mac", 12.0, REFERENCES["sarrus_linkage"])


def _dead_centres(extent: Extent) -> Findings:
    """Compare the first tip's place after many revolutions.

    Twice a revolution all rods are in line. There the parallelogram may turn into an antiparallelogram. The motion
    continues as the pendulum it has been.
    """
    linkage, needed, truth = problem("linkage.mac"), 6.0, REFERENCES["dead_centres"]
    until, turns = truth[extent]["until"], truth[extent]["revolutions"]
    motion, baseline = simulated(linkage, until), baseline_motion(linkage, until)
    place = translatable("place after %(turns)s revolutions", turns=turns)
    yield from place_digits(place, baseline, motion, truth[extent]["coordinates"], needed, scale=1)
    energy = digits_of_error(motion.energy_error, truth["energy"])
    yield graded(motion.engine, translatable("energy"), energy, needed)
    singular = Difficulty.SINGULAR_CONFIGURATION in motion.cases
    yield required(motion.engine, translatable("singular configuration reported"), singular)


def _stiff_spring(extent: Extent) -> Findings:
    """Compare the motion of a stiff spring next to a soft one."""
    rail, needed, truth = problem("hard/stiff_spring.mac"), 10.0, REFERENCES["stiff_spring"]
    until = truth[extent]["until"]
    motion, baseline = simulated(rail, until), baseline_motion(rail, until)
    coordinates = translatable("coordinates at t = %(t)s", t=until)
    yield from place_digits(coordinates, baseline, motion, truth[extent]["coordinates"], needed)
    energy = digits_of_error(motion.energy_error, truth["energy"])
    yield graded(motion.engine, translatable("energy"), energy, needed)


def _car_axis(extent: Extent) -> Findings:
    """Compare the published positions of an axis on a bumpy road."""
    axis, needed, truth = problem("car_axis.mac"), 10.0, REFERENCES["car_axis"]
    until = truth["until"]
    motion, baseline = simulated(axis, until, tol=1e-14), baseline_motion(axis, until)
    places = translatable("places at t = %(t)s", t=until)
    yield from place_digits(places, baseline, motion, truth["coordinates"], needed, scale=1)


PAPER = "paper/paper.mac", "free_motion_scene"


def _overflowing_control(extent: Extent) -> Findings:
    """Compare before and after the overflow of u^2 = (0.3 exp(t))^2 at t = 357.

    The multiplier is a quotient by 1 + 2 u^2: it should stay zero rather than become infinity by infinity.
    """
    paper, needed, truth = problem(*PAPER), 11.0, REFERENCES["overflowing_control"]
    for at in truth["motions"]:
        until = at["until"]
        motion, baseline = simulated(paper, until), baseline_motion(paper, until)
        coordinates = translatable("coordinates at t = %(t)s", t=until)
        yield from place_digits(coordinates, baseline, motion, at["coordinates"], needed)
        zero = digits_of_error(abs(motion.multipliers[0]) * at["gradient"], truth["initial_force"])
        yield graded(motion.engine, translatable("zero multiplier at t = %(t)s", t=until), zero, needed)


def _free_motion(extent: Extent) -> Findings:
    """Compare a constraint force with zero, relative to the other forces."""
    needed, truth = 13.0, REFERENCES["free_motion"]
    digits = {
        name: min(
            digits_of_error(abs(solve(at["t"], np.array(at["state"])).multipliers[0]) * at["gradient"], at["force"])
            for at in truth
        )
        for name, solve in every_solve(*PAPER).items()
    }
    yield from solve_digits(translatable("zero multiplier"), digits, needed, compared=(TEXTBOOK,))
    first, last = truth[0], truth[-1]
    motion = simulated(problem(*PAPER), last["t"])
    zero = digits_of_error(abs(motion.multipliers[0]) * last["gradient"], first["force"])
    yield graded(motion.engine, translatable("zero multiplier at t = %(t)s", t=last["t"]), zero, needed)


def _mass_ratio(extent: Extent) -> Findings:
    """Compare accelerations and positions of a heavy bob on a light chain.

    The light mass moves by the difference of two large reactions.
    """
    file, truth = "hard/heavy_bob.mac", REFERENCES["mass_ratio"]
    digits = {name: min(_acceleration_digits(truth, partial(solve, 0.0))) for name, solve in every_solve(file).items()}
    yield from solve_digits(translatable("accelerations"), digits, needed=12.0)
    motion = simulated(problem(file), truth["until"])
    places = correct_digits(motion.coordinates, truth["coordinates"])
    yield graded(motion.engine, translatable("places at t = %(t)s", t=truth["until"]), places, needed=10.0)


BASELINE_PERIODS = {Extent.SHORT: "50", Extent.FULL: "1000"}  # the baseline takes 20 ms for one
PERIODS = "10000"


def _long_run(extent: Extent) -> Findings:
    """Compare the position of a pendulum after many periods."""
    swinging, truth = problem("pendulum.mac", "swing_scene"), REFERENCES["long_run"]
    needed, needed_of_residual = 9.0, 12.0  # of the place rounding alone leaves eleven
    at = truth[BASELINE_PERIODS[extent]]
    state = baseline_motion(swinging, at["until"])
    place = translatable("place after %(periods)s periods", periods=BASELINE_PERIODS[extent])
    constraint = translatable("constraint")
    yield graded(BASELINE, place, correct_digits(state[:2], at["coordinates"]), needed, compared=True)
    residual = digits_of_error(abs(state[0] ** 2 + state[1] ** 2 - 1), 1)
    yield graded(BASELINE, constraint, residual, needed_of_residual, compared=True)
    at = truth[PERIODS]
    motion = simulated(swinging, at["until"])
    place = translatable("place after %(periods)s periods", periods=PERIODS)
    yield graded(motion.engine, place, correct_digits(motion.coordinates, at["coordinates"]), needed)
    for quantity, digits in (
        (constraint, digits_of_error(motion.residual, 1)),
        (translatable("energy"), digits_of_error(motion.energy_error, truth["energy"])),
    ):
        yield graded(motion.engine, quantity, digits, needed_of_residual)


def _vanishing_length(extent: Extent) -> Findings:
    """Require that a pendulum drawn in to its hinge stops there, with the reason."""
    engine, needed, truth = "taylor", 6.0, REFERENCES["vanishing_length"]
    for scene in ("straight_scene", "whirling_scene"):
        refused = _refusal(scene)
        facts = refused.facts if refused else {}
        digits = correct_digits([facts.get("time", nan)], [truth["time"]])
        yield graded(engine, translatable("time of the stop, %(scene)s", scene=scene), digits, needed)
        yield required(engine, translatable("constraint named"), facts.get("multiplier") == "lambda1")
        given = refused is not None and refused.kind is ErrorKind.NO_GRADIENT
        yield required(engine, translatable("reason given"), given)


def _refusal(scene: str) -> HolonomError | None:
    try:
        simulated(problem("hard/vanishing_length.mac", scene), until=2)
    except HolonomError as error:
        return error
    return None


REGISTER = (
    Case(
        translatable("parallel constraints"),
        Difficulty.NEARLY_DEPENDENT,
        translatable("a pendulum on the circle that the two rods leave free, in closed form"),
        _parallel_constraints,
    ),
    Case(
        translatable("constraint given twice"),
        Difficulty.REDUNDANT,
        translatable("the pendulum with one constraint, in elliptic functions"),
        _constraint_given_twice,
    ),
    Case(
        translatable("redundant spatial mechanism"),
        Difficulty.REDUNDANT,
        translatable("Sarrus' linkage reduced to the angle of its legs, a quadrature"),
        _sarrus_linkage,
    ),
    Case(
        translatable("parallelogram through its dead centres"),
        Difficulty.SINGULAR_CONFIGURATION,
        translatable("the rods' common angle, in elliptic functions"),
        _dead_centres,
    ),
    Case(
        translatable("spring 1e6 times stiffer"),
        Difficulty.STIFF,
        translatable("two coupled oscillators, in closed form"),
        _stiff_spring,
    ),
    Case(
        translatable("car axis"),
        Difficulty.STIFF,
        translatable("the published solution, right to about twelve decimals"),
        _car_axis,
    ),
    Case(
        translatable("overflowing control"),
        Difficulty.OVERFLOW,
        translatable("the paper's free motion, in closed form; its multiplier is zero"),
        _overflowing_control,
    ),
    Case(
        translatable("mass ratio of 1e12"),
        Difficulty.MASS_RATIO,
        translatable("two masses on two rods, by hand with 60 digits; the heavy one in free fall"),
        _mass_ratio,
    ),
    Case(
        translatable("pendulum for ten thousand periods"),
        Difficulty.LONG_RUN,
        translatable("the pendulum in elliptic functions"),
        _long_run,
    ),
    Case(
        translatable("cancellation along a free motion"),
        Difficulty.FREE_CANCELLATION,
        translatable("the paper's free motion under u = u0 exp(t), where every multiplier is zero"),
        _free_motion,
    ),
    Case(
        translatable("controlled length through zero"),
        Difficulty.VANISHING_LENGTH,
        translatable("the length 1 - t is zero at t = 1"),
        _vanishing_length,
    ),
)


def examine_all(extent: Extent, done: Callable[[], None]) -> list[CaseReport]:
    """Examine every case of the register.

    Parameters
    ----------
    extent : Extent
        Time span of the motions.
    done : callable
        Called without arguments after each case.

    Returns
    -------
    list of CaseReport
        One for each case, in the order of the register.
    """
    reports = []
    for case in REGISTER:
        reports.append(examined(case, extent))
        done()
    return reports
