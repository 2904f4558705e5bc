"""Programs of a motion with known signs, each a number or a sliding value.

A motion that is not analytic everywhere has signs as inputs of its programs (`maxima/program/switching.mac`). While
they stay the same, the motion is analytic, and its problem has the signs put in. The signs that make a motion slide on
switching surfaces are functions along the motion (`friction.py`).
"""

from collections.abc import Callable, Hashable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, TypeVar

from .drawing import Drawing
from .friction import SLIDING, Pattern, numbers_in, sliding_signs, sticking, with_sizes
from .motion_problem import DependsOn, Ends, MotionProblem, Servo
from .motion_program import Call, Name, Operation, Program
from .rewriting import computing, preceded, untaken, with_names_for_numbers, with_numbers

Part = TypeVar("Part", MotionProblem, Drawing, Ends, Servo)


def problem_in(problem: MotionProblem, pattern: Pattern) -> MotionProblem:
    """Return the analytic motion of one pattern of signs.

    Parameters
    ----------
    problem : MotionProblem
        The motion, with or without signs.
    pattern : mapping of str to int or str
        The sign of each function, 1, -1 or one that slides.

    Returns
    -------
    MotionProblem
        The motion without signs. `problem` itself if it has none.
    """
    if not problem.signs:
        return problem

    def build() -> MotionProblem:
        return _with_programs(problem, lambda program: program_in(problem, program, pattern))

    analytic = problem.once(frozenset(pattern.items()), problem.matrices, build)
    return replace(_begun(analytic, problem), signs=(), switching=None)


def program_in(problem: MotionProblem, program: Program, pattern: Pattern) -> Program:
    """Return a program of the motion with the signs of a pattern.

    Its inputs are those of the motion, but for the signs.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    program : Program
        One of its programs.
    pattern : Pattern
        The sign of each function, 1, -1 or one that slides.

    Returns
    -------
    Program
    """
    if SLIDING in pattern.values():
        program = with_sizes(program, pattern, sticking(pattern))
        program = preceded(sliding_signs(problem, pattern), program)
    return with_numbers(program, numbers_in(pattern))


def drawing_at_any_time(problem: MotionProblem) -> Drawing:
    """Return the drawing of the system, with each sign evaluated at the drawn state.

    Its program takes the time, the coordinates, the velocities and the multipliers alone.

    Parameters
    ----------
    problem : MotionProblem
        The motion. It has a drawing.

    Returns
    -------
    Drawing
    """
    program = problem.drawing.program
    for index, sign in reversed(list(enumerate(problem.signs, start=1))):
        function = computing(problem.switching, {f"switch[{index}]"})
        value = Call(Operation.SIGN, (function.outputs[f"switch[{index}]"],))
        if sign.by is DependsOn.REACTION:
            program = with_numbers(program, {sign.name: Fraction(1)})  # no drawing contains it
            continue
        assignments = (*function.assignments, (sign.name, value))
        program = preceded(replace(function, assignments=assignments, outputs={sign.name: Name(sign.name)}), program)
    return replace(problem.drawing, program=program)


def drawing_with_values(problem: MotionProblem) -> Drawing:
    """Return `drawing_at_any_time` with the values of the open parameters.

    Parameters
    ----------
    problem : MotionProblem
        The motion. It has a drawing.

    Returns
    -------
    Drawing
    """
    drawing = drawing_at_any_time(problem)
    return replace(drawing, program=program_with_values(problem, drawing.program))


def driven(problem: MotionProblem, name: str) -> bool:
    """Return True if the accelerations on both sides of a sign change are known.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    name : str
        One of its signs.

    Returns
    -------
    bool
    """
    return problem.switching is not None and f"drive[{problem.places[name]}]" in problem.switching.outputs


def program_with_values(problem: MotionProblem, program: Program) -> Program:
    """Return a program of the motion with the values of the open parameters.

    Parameters
    ----------
    problem : MotionProblem
        The motion, with the values.
    program : Program
        One of its programs.

    Returns
    -------
    Program
    """
    return with_numbers(program, problem.values) if problem.parameters else program


def with_values_in(problem: MotionProblem) -> MotionProblem:
    """Return the motion with the values of all open parameters put into its programs.

    Parameters
    ----------
    problem : MotionProblem
        The motion.

    Returns
    -------
    MotionProblem
    """
    if not problem.parameters:
        return problem
    changed = _with_programs(problem, lambda program: program_with_values(problem, program))
    released = tuple(
        replace(each, after=with_values_in(replace(each.after, values=problem.values)))
        for each in problem.ends.released
    )
    return replace(
        changed,
        switching=problem.switching and program_with_values(problem, problem.switching),
        ends=replace(changed.ends, released=released),
        parameters=(),
        values={},
        initial=replace(problem.initial, parametric=None),
    )


def at_start(problem: MotionProblem) -> MotionProblem:
    """Return the initial motion: each table is the polynomial around that time.

    Parameters
    ----------
    problem : MotionProblem
        The motion.

    Returns
    -------
    MotionProblem
    """
    if not problem.tables:
        return problem

    def build() -> MotionProblem:
        numbers = {name: number for table in problem.tables for name, number in table.first.items()}
        begun = _with_programs(problem, lambda program: with_numbers(program, numbers))
        return replace(begun, switching=problem.switching and with_numbers(problem.switching, numbers), tables=())

    begun = problem.once("at start", problem.matrices, build)
    return _begun(begun, problem)


def _begun(motion: MotionProblem, problem: MotionProblem) -> MotionProblem:
    """Return a motion that starts as another one does."""
    shared = ("start", "values", "initial", "nominal")
    return replace(motion, **{name: getattr(problem, name) for name in shared})


def sharing_programs(problem: MotionProblem, known: dict[Hashable, MotionProblem]) -> MotionProblem:
    """Return a motion with the numbers of its laws as values of parameters.

    The polynomials of a law, of a table above all, differ only in their numbers. Motions with the same programs share
    them, and their compiled functions.

    Parameters
    ----------
    problem : MotionProblem
        Without signs.
    known : dict
        The motions given so far. Changed in place.

    Returns
    -------
    MotionProblem
    """
    numbers: dict[str, Fraction] = {}
    assigned = {name for name, _ in problem.matrices.assignments}
    laws = {
        dots.format(name) for name in assigned if f"dot({name})" in assigned for dots in ("{}", "dot({})", "ddot({})")
    }
    symbols = untaken("piece", {symbol.rstrip("0123456789") for symbol in {*assigned, *problem.matrices.inputs}})

    def opened(program: Program) -> Program:
        assignments = []
        for name, expression in program.assignments:
            if name in laws:
                expression, named = with_names_for_numbers(expression, f"{symbols}_{sorted(laws).index(name)}_")
                numbers.update(named)
            assignments.append((name, expression))
        return replace(program, assignments=tuple(assignments))

    def taking(program: Program) -> Program:
        before = len(program.inputs) - len(problem.open_inputs) + len(problem.parameters)
        return replace(program, inputs=(*program.inputs[:before], *numbers, *program.inputs[before:]))

    shared = _with_programs(_with_programs(problem, opened), taking)
    shared = replace(shared, parameters=(*problem.parameters, *numbers), values={**problem.values, **numbers})
    template = known.setdefault(_text(shared), shared)
    return replace(template, values=shared.values, start=shared.start, nominal=shared.nominal)


def _text(problem: MotionProblem) -> Hashable:
    """Return the common part of motions that only differ in values and initial state."""
    programs: list[Program | None] = []
    _with_programs(problem, lambda program: programs.append(program) or program)
    return tuple((each.inputs, each.assignments, tuple(each.outputs.items())) for each in programs)


def switching_function(problem: MotionProblem, quantity: str, name: str, pattern: Pattern) -> Program:
    """Return one function that decides how the motion passes a switching surface.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    quantity : str
        ``switch``, the function whose sign it is. ``switch_rate``, its time derivative, or ``drive``, its first time
        derivative that contains accelerations, with the sign's value from the pattern.
    name : str
        One of the signs.
    pattern : Pattern
        As for `problem_in`.

    Returns
    -------
    Program
        Program with one output.
    """
    return program_in(problem, computing(problem.switching, {f"{quantity}[{problem.places[name]}]"}), pattern)


def switching_functions(problem: MotionProblem, pattern: Pattern, names: Sequence[str]) -> Program:
    """Return the functions with which signs of a pattern end.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    pattern : Pattern
        As for `problem_in`.
    names : sequence of str
        Some of the signs.

    Returns
    -------
    Program
        An output by the name of each sign: its function, or the sign itself if it slides.
    """
    functions = problem.switching.outputs
    outputs = {
        name: Name(name) if pattern[name] == SLIDING else functions[f"switch[{problem.places[name]}]"] for name in names
    }
    return program_in(problem, computing(replace(problem.switching, outputs=outputs), names), pattern)


def _with_programs(part: Part, changed: Callable[[Program], Program]) -> Part:
    """Return the motion, or a part, with programs but the switching one changed."""

    def new(value: Any) -> Any:
        match value:
            case Program():
                return changed(value)
            case Drawing() | Ends() | Servo():
                return _with_programs(value, changed)
            case _:
                return value

    return replace(part, **{name: new(value) for name, value in vars(part).items() if name != "switching"})
