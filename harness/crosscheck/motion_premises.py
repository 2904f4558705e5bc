"""Compare the premises of motions with the description.

The premises are names, initial state, time span, laws, controls, events and outputs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from mpmath import mp

from ..program.motion_problem import MotionProblem
from ..program.motion_program import Name, Program
from ..program.request import Solve
from ..program.rewriting import computing
from .compared_values import Parts, differing
from .described_motion import DescribedMotion
from .digits import WORKING_DIGITS
from .irregular_point import IrregularPoint
from .law import Law
from .motion_start import START_DIGITS, nearer_start, values_of_start
from .motion_states import STATE, ComparedValue, States, values_of_law
from .program_values import outputs_of, run
from .switches import law_times
from .taylor import Taylor

PREMISES = "start, time span, laws, controls, events and outputs of the motion"
LAW = Taylor(3)


def other_premises(motion: DescribedMotion, problems: Mapping[Solve, MotionProblem], seed: str) -> str:
    """Return the premises of problems that differ from the description.

    The text is empty if all agree.

    Parameters
    ----------
    motion : DescribedMotion
        The description.
    problems : mapping of Solve to MotionProblem
        Maxima's problem for each solve.
    seed : str
        Seed of the random states.

    Returns
    -------
    str
        The first difference found.
    """
    for problem in problems.values():
        for what, (found, belongs) in _stated(motion, problem).items():
            if tuple(found) != tuple(belongs):
                return f"{what}: {_listed(found)}, where {_listed(belongs)} is stated"
        if wrong := differing(lambda problem=problem: _compared(motion, problem, seed), START_DIGITS):
            return wrong
    if motion.ended:
        return ""
    with mp.workdps(WORKING_DIGITS):
        first = next(iter(problems.values()))
        return nearer_start(motion, _start(first), _masses(motion, first))


def _masses(motion: DescribedMotion, problem: MotionProblem) -> dict[str, mp.mpf]:
    """Return masses of the controls among the coordinates, the last ones.

    That they have masses is a convention of the problem.
    """
    places = {u: problem.coordinates.index(u) + 1 for u in motion.moved}
    found = {u: problem.matrices.outputs.get(f"A[{s},{s}]") for u, s in places.items()}
    return {u: mp.mpf(mass.numerator) / mass.denominator for u, mass in found.items() if isinstance(mass, Fraction)}


def _stated(motion: DescribedMotion, problem: MotionProblem) -> dict[str, tuple[Sequence[str], Sequence[str]]]:
    """Return names in a problem, and the described names."""
    scene, system = motion.scene, motion.system
    events = [f"event[{i}]" for i in range(1, len(scene.until_trees) + 1)]
    return {
        "coordinates": (problem.coordinates, (*system.coordinates, *motion.freed, *motion.moved)),
        "multipliers": (problem.reactions, system.multipliers),
        "multipliers in forces": (problem.reacting, motion.reacting),
        "observe": (problem.observe, scene.observe),
        "time span": (["some"] * bool(problem.time_span), ["some"] * bool(motion.span)),
        "events": (list(problem.ends.events.outputs) if problem.ends.events else [], events),
        "until": (["one"] * len(problem.ends.until), ["one"] * len(events)),
        "outputs": (list(problem.outputs.outputs) if problem.outputs else [], list(scene.outputs)),
        "released": (
            [name for each in problem.ends.released for name in (*each.multipliers, "then")],
            [name for each in scene.released for name in (*each.multipliers, "then")],
        ),
    }


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names) or "none"


def _start(problem: MotionProblem) -> dict[str, mp.mpf]:
    return {name: mp.mpf(text) for name, text in problem.start.items()}


def _compared(motion: DescribedMotion, problem: MotionProblem, seed: str) -> Iterator[ComparedValue]:
    """Compare initial state, time span, and laws of a problem's programs.

    The laws are compared at the times of `law_times`.
    """
    if not motion.ended:  # the initial state is that of the motion before any release
        yield from values_of_start(motion, _start(problem), problem.initial.correction)
    for found, belongs in zip(problem.time_span or (), motion.span or (), strict=True):
        yield ComparedValue("time span", mp.mpf(found), belongs, abs(belongs))
    own = States(motion, problem, seed)
    programs = _law_programs(motion, problem)
    for place, time in enumerate(law_times(motion, problem, own.span)):
        state = own.state(place) | {"t": (time, mp.one)}
        try:
            inputs = own.inputs(state, own.random_numbers(place, len(problem.multipliers)))
            law = motion.law.at(LAW, time, motion.parameters())
            law |= motion.reactions.at(LAW, time, motion.parameters())
            computed = [outputs_of(program, inputs) for program in programs]
        except (IrregularPoint, ZeroDivisionError, OverflowError):
            continue
        for values in computed:
            for value in values_of_law(law, values):
                yield value._replace(quantity=f"{value.quantity} at t = {mp.nstr(time, 12)}")


def _law_programs(motion: DescribedMotion, problem: MotionProblem) -> list[Program]:
    """Return the parts of a problem's programs that compute laws, each once."""
    laws = [
        f"{dots}{name}{end}" for name in motion.law.places for dots, end in (("", ""), ("dot(", ")"), ("ddot(", ")"))
    ]
    found: list[Program] = []
    for program in (problem.matrices, problem.energy, problem.motion, problem.projection):
        if program is None:
            continue
        assigned = {name for name, _ in program.assignments}
        outputs = {name: Name(name) for name in laws if name in assigned}
        outputs |= {name: program.outputs[name] for name in motion.reactions.places if name in program.outputs}
        part = computing(replace(program, outputs=outputs), outputs)
        if part not in found:
            found.append(part)
    return found


def values_of_inputs(
    motion: DescribedMotion, problems: Mapping[Solve, MotionProblem], seed: str
) -> Callable[[int], Parts]:
    """Compare controls, events and outputs at random states.

    The energy is compared elsewhere.

    Parameters
    ----------
    motion : DescribedMotion
        The description.
    problems : mapping of Solve to MotionProblem
        Maxima's problem for each solve.
    seed : str
        Seed of the random states.

    Returns
    -------
    callable
        Function from the number of an attempt to values at its state.
    """
    drawn = {solve: States(motion, problem, seed) for solve, problem in problems.items()}
    stated = motion.scene.until_trees, [each.condition for each in motion.scene.released]
    expressions = [Law({f"event[{i}]": tree for i, tree in enumerate(trees, 1)}, motion.splines) for trees in stated]
    outputs = Law(motion.scene.outputs.trees, motion.splines)

    def compared(attempt: int) -> Parts:
        for solve, own in drawn.items():
            problem, state = problems[solve], own.state(attempt)
            inputs = own.inputs(state, own.random_numbers(attempt, len(problem.multipliers)))
            found = inputs if problem.motion is None else inputs | run(problem.motion, inputs)
            law = motion.law.at(LAW, state["t"][0], motion.parameters())
            controls = {name: law.get(name) or found[name] for name in motion.system.controls if name in law | found}
            if problem.controls is not None:
                computed = run(problem.controls, inputs)
                given = {name: true for name, true in controls.items() if name not in problem.coordinates}
                given |= {name: found[name] for name in map("ddot({})".format, motion.moved) if name in found}
                for name, true in given.items():
                    yield PREMISES, ComparedValue(name, computed[name][0], true[0], abs(true[0]))
            known = motion.parameters() | inputs | motion.with_derivatives(LAW, controls | inputs)
            for program, conditions in zip((problem.ends.events, problem.ends.releases), expressions, strict=True):
                computed = {} if program is None else run(program, inputs)
                for name, true in conditions.at(STATE, state["t"][0], known).items():
                    yield PREMISES, ComparedValue(name, computed[name][0], true[0], abs(true[0]))
            if problem.outputs is not None:
                given = own.random_numbers(attempt, len(problem.coordinates))
                inputs |= {f"ddot({q})": (x,) for q, x in zip(problem.coordinates, given, strict=True)}
                rates = {f"ddot({u})": LAW.rate(LAW.rate(x)) for u, x in law.items()}
                known |= rates | inputs | {"energy": run(problem.energy, inputs)["energy"]}
                computed = run(problem.outputs, inputs)
                for name, true in outputs.at(STATE, state["t"][0], known).items():
                    yield PREMISES, ComparedValue(name, computed[name][0], true[0], abs(true[0]))

    return compared
