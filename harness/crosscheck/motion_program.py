"""Verdicts on motion programs: the simulated equations at random states.

Nothing is taken from the record. Accelerations and multipliers of both solves, the control law and its derivatives,
the corrections of the state, residuals, energy and power are compared with the description in 50 digits.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import partial

from mpmath import mp

from ..description import DescribedScene, Description
from ..failures import ErrorKind, HolonomError
from ..program.motion_problem import MotionProblem, read_problem
from ..program.motion_program import Program, read_program
from ..program.request import Solve
from . import motion_states as states
from .compared_values import Parts, first_differences
from .described_motion import DescribedMotion
from .digits import DIGITS, POINTS
from .irregular_point import IrregularPoint
from .motion_premises import PREMISES, other_premises, values_of_inputs
from .motion_states import STATE, ComparedValue, States
from .program_values import Values, run
from .questions import Answer, SceneAndSolve, holds_special_functions, is_closed
from .report import CheckResult, Verdict

ATTEMPTS = 6  # draws for each state before the search for a regular one is given up


@dataclass(frozen=True)
class ScenePrograms:
    """The programs of a scene or system, or the reason for missing ones."""

    scene: str | None
    problems: Mapping[Solve, MotionProblem] = field(default_factory=dict)  # where the controls have laws
    programs: Mapping[Solve, Program] = field(default_factory=dict)  # where they have none
    missing: Mapping[Solve, CheckResult] = field(default_factory=dict)


OF_SPECIAL_FUNCTIONS = CheckResult(
    Verdict.NOTHING, None, None, "special functions of the time are not compared in 50 digits"
)


@dataclass(frozen=True)
class ProgramVerdict:
    """The verdict on one part of the programs of a scene."""

    scene: str | None
    part: str
    found: CheckResult


def read_programs(description: Description, answers: Mapping[SceneAndSolve, Answer]) -> list[ScenePrograms]:
    """Read Maxima's answers about programs.

    Parameters
    ----------
    description : Description
        The reference.
    answers : mapping of SceneAndSolve to Answer
        Document or error for each scene and solve.

    Returns
    -------
    list of ScenePrograms
        One for each scene, or one for a system without scenes.

    Raises
    ------
    HolonomError
        An answer is not a document of the expected form.
    """
    return [_programs_of(description, scene, answers) for scene in description.scenes or (None,)]


def _programs_of(
    description: Description, scene: DescribedScene | None, answers: Mapping[SceneAndSolve, Answer]
) -> ScenePrograms:
    name = scene and scene.name
    if holds_special_functions(description):
        return ScenePrograms(name, missing=dict.fromkeys(Solve, OF_SPECIAL_FUNCTIONS))
    own = {solve: answers[name, solve] for solve in Solve}
    missing = {solve: why_missing(answer) for solve, answer in own.items() if isinstance(answer, HolonomError)}
    closed = is_closed(description, scene)
    read = read_problem if closed else read_program
    found = {solve: read(answer) for solve, answer in own.items() if solve not in missing}
    return ScenePrograms(name, **{"problems" if closed else "programs": found}, missing=missing)


def why_missing(error: HolonomError) -> CheckResult:
    """Return the verdict for missing output of Maxima.

    Parameters
    ----------
    error : HolonomError
        Error of the run of Maxima.

    Returns
    -------
    CheckResult
        Nothing to check, or undecided after a limit.

    Raises
    ------
    HolonomError
        The error itself, if it is neither an id of Maxima nor a limit.
    """
    if error.kind is ErrorKind.REFUSED:
        return CheckResult(Verdict.NOTHING, None, None, error.reason)
    if error.kind in (ErrorKind.TOO_LONG, ErrorKind.TOO_LARGE):
        return CheckResult(Verdict.UNDECIDED, None, None, error.reason)
    raise error


def verify_programs(description: Description, programs: Iterable[ScenePrograms], seed: str) -> list[ProgramVerdict]:
    """Return verdicts on the programs of the scenes of a description.

    Parameters
    ----------
    description : Description
        The reference.
    programs : iterable of ScenePrograms
        The programs that Maxima wrote.
    seed : str
        Seed of the random states.

    Returns
    -------
    list of ProgramVerdict
        One for each part of the programs.
    """
    scenes = {scene.name: scene for scene in description.scenes}
    verdicts = []
    for each in programs:
        motion = DescribedMotion(description, scenes.get(each.scene))
        for solve, result in each.missing.items():
            verdicts.append(ProgramVerdict(each.scene, f"motion program, {solve} solve", result))
        if each.problems:
            verdicts += _verify_with_releases(motion, each, seed)
        for solve, program in each.programs.items():
            maker = _open_states(motion, program, seed)
            verdicts += _verify(each.scene, [f"motion program, {solve} solve"], maker)
    return verdicts


def _verify_with_releases(motion: DescribedMotion, programs: ScenePrograms, seed: str) -> list[ProgramVerdict]:
    """Return verdicts on the initial motion, and on that after each release.

    The releases are tried in every order.
    """
    verdicts = _verify_problems(motion, programs, seed)
    problems = programs.problems
    if any(len(each.ends.released) != len(motion.scene.released) for each in problems.values()):
        return verdicts
    for k, release in enumerate(next(iter(problems.values())).ends.released):
        after = replace(programs, problems={solve: each.ends.released[k].after for solve, each in problems.items()})
        verdicts += [
            replace(each, part=f"{each.part}; after {release.of} = 0")
            for each in _verify_with_releases(motion.after(k), after, seed)
        ]
    return verdicts


def _verify_problems(motion: DescribedMotion, programs: ScenePrograms, seed: str) -> list[ProgramVerdict]:
    problems = programs.problems
    try:
        wrong, irregular = other_premises(motion, problems, seed), ""
    except IrregularPoint:
        wrong, irregular = "", "an expression has no derivatives in the initial state"
    if wrong:
        return [ProgramVerdict(programs.scene, PREMISES, CheckResult(Verdict.DISAGREES, DIGITS, 1, wrong))]
    solved = [solve for solve, problem in problems.items() if problem.motion is not None]
    parts = [f"motion program, {solve} solve" for solve in solved]
    verdicts = [
        ProgramVerdict(
            programs.scene,
            f"motion program, {solve} solve",
            CheckResult(Verdict.NOTHING, None, None, problem.obstruction or ""),
        )
        for solve, problem in problems.items()
        if problem.motion is None
    ]
    if motion.scene.prescribed_reactions:
        maker = _released_states(motion, problems, seed)
    else:
        maker = _plain_states(motion, problems, seed)
        parts = [MATRICES, *parts]
    if irregular:
        undecided = CheckResult(Verdict.UNDECIDED, None, None, irregular)
        verdicts.append(ProgramVerdict(programs.scene, PREMISES, undecided))
    else:
        verdicts += _verify(programs.scene, [PREMISES], values_of_inputs(motion, problems, seed))
    return [*verdicts, *_verify(programs.scene, parts, maker)]


def _values_of(program: Program, inputs: Values, solve: Solve) -> Values | None:
    """Return values of a program.

    None if it must have values and has none: the orthogonal solve requires positive masses.

    Raises
    ------
    IrregularPoint
        The orthogonal solve has no value.
    """
    try:
        return run(program, inputs)
    except (IrregularPoint, ZeroDivisionError):
        if solve is Solve.ORTHOGONAL:
            raise
        return None


MATRICES = "control law, mass matrix, forces, residuals and energy of the motion"


def _plain_states(
    motion: DescribedMotion, problems: Mapping[Solve, MotionProblem], seed: str
) -> Callable[[int], Parts]:
    drawn = {solve: States(motion, problem, seed) for solve, problem in problems.items()}
    first = next(iter(problems.values()))
    n, names = len(first.coordinates), [*(f"ddot({q})" for q in first.coordinates), *first.multipliers]
    redundant = next((p.motion.redundant for p in problems.values() if p.motion is not None), ())

    def compared(attempt: int) -> Parts:
        own = drawn[next(iter(problems))]
        state = own.state(attempt)
        x = own.random_numbers(attempt, len(names))
        x[len(names) - first.servo.constraints :] = [mp.zero] * first.servo.constraints
        if first.reacting:
            system = states.bordered(run(first.matrices, own.inputs(state, x[n:])), n, first.multipliers, redundant)
            x[n:] = system.solution(system.right)[n:]
        inputs = own.inputs(state, x[n:])
        computed, energy = run(first.matrices, inputs), run(first.energy, inputs)
        controls = own.controls(state, computed)
        system = states.bordered(computed, n, first.multipliers, redundant)
        law = {name: value for name, value in controls.items() if name in motion.scene.control_law}
        computed |= {name: energy[name] for name in ("energy", "power")}
        for program in (computed, energy):
            yield from ((MATRICES, value) for value in states.values_of_law(law, program))
        curve = own.curve(state, dict(zip(first.coordinates, x, strict=False)), controls)
        curve |= {name: inputs[name] for name in first.reacting}
        yield from ((MATRICES, value) for value in states.values_of_matrices(motion, system, computed, curve, x))
        for problem in problems.values():
            if (problem.matrices, problem.energy) != (first.matrices, first.energy):
                for both in ((problem.matrices, first.matrices), (problem.energy, first.energy)):
                    yield from ((MATRICES, value) for value in _values_alike(*both, inputs))
        for solve, problem in problems.items():
            if problem.projection is not None:
                part = f"motion program, {solve} solve"
                corrections = run(problem.projection, inputs)
                yield from ((part, value) for value in states.values_of_law(law, corrections))
                for which in ("position", "velocity"):
                    found = states.values_of_projection(system, corrections, computed, which)
                    yield from ((part, value) for value in found)
        if first.servo.constraints:
            state = own.holding(state)
            inputs = own.inputs(state, x[n:])
            system = states.bordered(run(first.matrices, inputs), n, first.multipliers, redundant)
            law = own.controls(state, {})
        solution = system.solution(system.right)
        for solve, problem in problems.items():
            if problem.motion is None:
                continue
            part = f"motion program, {solve} solve"
            found = _values_of(problem.motion, inputs, solve)
            if found is None:
                yield part, ComparedValue("a value", mp.zero, mp.one, mp.one)
                continue
            yield from ((part, value) for value in states.values_of_law(law, found))
            yield from (
                (part, each)
                for each in states.values_of_solve(system, solution, found, names, problem.servo.constraints)
            )
            yield from ((part, each) for each in states.values_of_constraint_forces(system, found, names))

    return compared


def _values_alike(program: Program, true: Program, inputs: Values) -> Iterator[ComparedValue]:
    """Compare the outputs of two programs."""
    found, wanted = run(program, inputs), run(true, inputs)
    for name in {**true.outputs, **program.outputs}:
        x, y = ((*each.get(name, ()), mp.inf)[0] for each in (found, wanted))
        yield ComparedValue(name, x, y, abs(y))


def _released_states(
    motion: DescribedMotion, problems: Mapping[Solve, MotionProblem], seed: str
) -> Callable[[int], Parts]:
    """Return states of a scene that prescribes reactions.

    Its free controls are coordinates, and the prescribed reactions hold.
    """
    drawn = {solve: States(motion, problem, seed) for solve, problem in problems.items() if problem.motion is not None}

    def compared(attempt: int) -> Parts:
        for solve, own in drawn.items():
            problem, part = problems[solve], f"motion program, {solve} solve"
            state = own.holding(own.state(attempt))
            found = run(problem.motion, own.inputs(state, own.random_numbers(attempt, len(problem.multipliers))))
            controls = own.controls(state, found)
            prescribed = motion.reactions.at(STATE, state["t"][0], motion.parameters())
            for name, value in prescribed.items():
                yield part, ComparedValue(name, found[name][0], value[0], abs(value[0]))
            accelerations = {q: found[f"ddot({q})"][0] for q in problem.coordinates}
            multipliers = [found[name][0] for name in motion.system.multipliers]
            size = mp.fsum(map(abs, (*accelerations.values(), *multipliers)))
            for name in problem.multipliers[len(multipliers) :]:
                yield part, ComparedValue(name, found[name][0], mp.zero, size)
            curve = own.curve(state, accelerations, controls)
            x = [*accelerations.values(), *(found[name][0] for name in problem.multipliers)]
            inputs = own.inputs(state, x[len(accelerations) :])
            computed = run(problem.matrices, inputs) | run(problem.energy, inputs)
            system = states.bordered(computed, len(accelerations), problem.multipliers, problem.motion.redundant)
            yield from ((part, each) for each in states.values_along_motion(motion, system, computed, curve, x))
            holding = [*motion.constraints, *motion.outputs]
            yield from ((part, each) for each in states.values_by_substitution(motion, curve, multipliers, holding))

    return compared


def _open_states(motion: DescribedMotion, program: Program, seed: str) -> Callable[[int], Parts]:
    """Return states of a program whose controls, and some parameters, are inputs."""
    system, part = motion.system, f"motion program, {program.solve} solve"
    holding = [
        place
        for place, name in zip(motion.constraints, system.multipliers, strict=True)
        if name not in program.redundant
    ]
    if f"lambda{len(motion.constraints) + len(motion.outputs) + 1}" not in program.outputs:  # all of relative degree 2
        holding += motion.outputs

    def compared(attempt: int) -> Parts:
        import random

        draw = random.Random(f"{seed} {attempt}")
        low = -2 if attempt % 4 == 1 else 0
        inputs = {name: (mp.mpf(draw.randint(low * 2**40, 2**41)) / 2**40,) for name in program.inputs}
        given = motion.parameters()
        found = run(program, inputs)
        curve: Values = {name: inputs[name] for name in system.parameters if name in inputs} | given
        curve["t"] = (inputs.get("t", (mp.zero,))[0], mp.one)
        for u in system.controls:
            history = [(inputs | found).get(name, (mp.zero,))[0] for name in (u, f"dot({u})", f"ddot({u})")]
            curve[u] = (history[0], history[1], history[2] / 2)
        for q in system.coordinates:
            curve[q] = (inputs[q][0], inputs[f"dot({q})"][0], found[f"ddot({q})"][0] / 2)
        multipliers = [found[name][0] for name in system.multipliers]
        yield from ((part, each) for each in states.values_by_substitution(motion, curve, multipliers, holding))

    return compared


def _verify(scene: str | None, parts: list[str], compared: Callable[[int], Parts]) -> list[ProgramVerdict]:
    """Compare at random states until there are enough or one part is wrong."""
    wrong: dict[str, str] = {}
    points = 0
    for attempt in range(ATTEMPTS * POINTS):
        if points == POINTS or len(wrong) == len(parts):
            break
        differences, regular = first_differences(partial(compared, attempt))
        wrong = differences | wrong
        points += regular
    few = f"only {points} regular states were found among {ATTEMPTS * POINTS}"
    left = CheckResult(Verdict.AGREES, DIGITS, POINTS) if points == POINTS else None
    left = left or CheckResult(Verdict.UNDECIDED, None, points or None, few)
    return [
        ProgramVerdict(
            scene, part, CheckResult(Verdict.DISAGREES, DIGITS, POINTS, wrong[part]) if part in wrong else left
        )
        for part in parts
    ]
