"""Programs of a motion whose signs are known: each is a number, or what keeps the motion on its surface.

A motion that is not analytic everywhere comes with signs as inputs of its programs (`maxima/program/switching.mac`).
While they stay the same it is an analytic motion like any other: its problem is the same one with the signs put in.
A sign that holds the motion on its surface is a value along the way, -drive(0)/grip.
"""

from collections.abc import Callable, Hashable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction

from .drawing import Drawing
from .folding import ZERO, folded
from .motion_problem import MotionProblem, computing
from .motion_program import Call, Constant, Expression, Name, Operation, Program, count_operations

SLIDING = "held"  # stands in a pattern for the sign that keeps the motion on its surface
Pattern = Mapping[str, int | str]


def problem_in(problem: MotionProblem, pattern: Pattern) -> MotionProblem:
    """Return the analytic motion of one pattern of signs.

    Parameters
    ----------
    pattern : mapping of str to int or str
        1, -1 or `SLIDING` for each sign; one at most is held, of those that `holdable` names.
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
    """
    for name, sign in pattern.items():
        if sign == SLIDING:
            program = _preceded(_holding(problem, name), program)
    return with_numbers(program, {name: Fraction(sign) for name, sign in pattern.items() if sign != SLIDING})


def drawing_at_any_time(problem: MotionProblem) -> Drawing:
    """Return how the system looks, each sign as it is at the state drawn.

    Its program takes the time, the coordinates, the velocities and the multipliers alone.
    """
    program = problem.drawing.program
    for index, sign in reversed(list(enumerate(problem.signs, start=1))):
        function = computing(problem.switching, {f"switch[{index}]"})
        value = Call(Operation.SIGN, (function.outputs[f"switch[{index}]"],))
        assignments = (*function.assignments, (sign.name, value))
        program = _preceded(replace(function, assignments=assignments, outputs={sign.name: Name(sign.name)}), program)
    return replace(problem.drawing, program=program)


def drawing_in_numbers(problem: MotionProblem) -> Drawing:
    """As `drawing_at_any_time`, with the values of the open parameters put in."""
    drawing = drawing_at_any_time(problem)
    return replace(drawing, program=in_numbers(problem, drawing.program))


def holdable(problem: MotionProblem, name: str) -> bool:
    """Return True if a sign can hold the motion on its surface: forces alone contain it, and linearly."""
    return problem.switching is not None and f"grip[{_index(problem, name)}]" in problem.switching.outputs


def in_numbers(problem: MotionProblem, program: Program) -> Program:
    """Return a program of the motion with the values of the open parameters put in."""
    return with_numbers(program, problem.values) if problem.parameters else program


def with_values_in(problem: MotionProblem) -> MotionProblem:
    """Return the motion with the values of its parameters put into its programs, none left open."""
    if not problem.parameters:
        return problem
    return replace(
        _with_programs(problem, lambda program: in_numbers(problem, program)),
        switching=problem.switching and in_numbers(problem, problem.switching),
        released=tuple(
            replace(each, after=with_values_in(replace(each.after, values=problem.values))) for each in problem.released
        ),
        parameters=(),
        values={},
        parametric_start=None,
    )


def at_start(problem: MotionProblem) -> MotionProblem:
    """Return the motion as it begins: each table is the polynomial around the start."""
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
    kept = ("start", "values", "correction", "moved", "nominal")
    return replace(motion, **{name: getattr(problem, name) for name in kept})


def sharing_programs(problem: MotionProblem, known: dict[Hashable, MotionProblem]) -> MotionProblem:
    """Return a motion with the numbers of its laws as values of parameters.

    The pieces of a law, of a table above all, differ in their numbers alone: motions that do so are given the same
    programs, and what is compiled of them is compiled once.

    Parameters
    ----------
    problem : MotionProblem
        Without signs.
    known : dict
        The motions given so far; changed in place.
    """
    numbers: dict[str, Fraction] = {}
    assigned = {name for name, _ in problem.matrices.assignments}
    laws = {
        dots.format(name) for name in assigned if f"dot({name})" in assigned for dots in ("{}", "dot({})", "ddot({})")
    }
    letters = _untaken("piece", {letter.rstrip("0123456789") for letter in {*assigned, *problem.matrices.inputs}})

    def opened(program: Program) -> Program:
        assignments = []
        for name, expression in program.assignments:
            if name in laws:
                start = f"{letters}_{sorted(laws).index(name)}_"
                expression = _with_names_for_numbers(expression, start, numbers)
            assignments.append((name, expression))
        return replace(program, assignments=tuple(assignments))

    def taking(program: Program) -> Program:
        before = len(program.inputs) - len(problem.open_inputs) + len(problem.parameters)
        return replace(program, inputs=(*program.inputs[:before], *numbers, *program.inputs[before:]))

    shared = _with_programs(_with_programs(problem, opened), taking)
    shared = replace(shared, parameters=(*problem.parameters, *numbers), values={**problem.values, **numbers})
    template = known.setdefault(_text(shared), shared)
    return replace(template, values=shared.values, start=shared.start, nominal=shared.nominal)


def _with_names_for_numbers(expression: Expression, start: str, numbers: dict[str, Fraction]) -> Expression:
    """Return the expression with a name for each of its numbers, exponents apart.

    The numbers are put under these names.
    """
    count = 0

    def named(part: Expression) -> Expression:
        nonlocal count
        match part:
            case Fraction():
                name, count = f"{start}{count}", count + 1
                numbers[name] = part
                return Name(name)
            case Call(Operation.POWER, (base, exponent)):
                return Call(Operation.POWER, (named(base), exponent))
            case Call(operation, arguments):
                return Call(operation, tuple(map(named, arguments)))
            case _:
                return part

    return named(expression)


def _text(problem: MotionProblem) -> Hashable:
    """Return what two motions have in common that differ in values and start alone."""
    programs: list[Program | None] = []
    _with_programs(problem, lambda program: programs.append(program) or program)
    return tuple((each.inputs, each.assignments, tuple(each.outputs.items())) for each in programs)


def switching_function(problem: MotionProblem, quantity: str, name: str, pattern: Pattern) -> Program:
    """One function that decides how the motion passes a surface.

    Parameters
    ----------
    problem, pattern
        As for `problem_in`.
    quantity : str
        ``switch`` or ``switch_rate``; ``drive``, the rate that the value which the pattern has for the sign contributes
        to of its own function, for a sign that `holdable` is true of.
    name : str
        One of the signs.
    """
    return program_in(problem, computing(problem.switching, {f"{quantity}[{_index(problem, name)}]"}), pattern)


def with_numbers(program: Program, numbers: Mapping[str, Fraction]) -> Program:
    """Return a program with numbers for some of its inputs; what is multiplied by zero is dropped."""
    known: dict[str, Expression] = dict(numbers)
    kept = []
    for name, expression in program.assignments:
        value = _substituted(expression, known)
        kept.append((name, value))
        if isinstance(value, Fraction | Name | Constant):
            known[name] = value
    part = replace(
        program,
        inputs=tuple(name for name in program.inputs if name not in numbers),
        assignments=tuple(kept),
        outputs={name: _substituted(value, known) for name, value in program.outputs.items()},
    )
    return computing(part, part.outputs)


def _with_programs(problem: MotionProblem, changed: Callable[[Program], Program]) -> MotionProblem:
    """Return the motion with each of its programs changed, but for that of the switching."""
    return replace(
        problem,
        motion=problem.motion and changed(problem.motion),
        projection=problem.projection and changed(problem.projection),
        matrices=changed(problem.matrices),
        energy=changed(problem.energy),
        drawing=problem.drawing and replace(problem.drawing, program=changed(problem.drawing.program)),
        events=problem.events and changed(problem.events),
        releases=problem.releases and changed(problem.releases),
        controls=problem.controls and changed(problem.controls),
        outputs=problem.outputs and changed(problem.outputs),
        servo_matrix=problem.servo_matrix and changed(problem.servo_matrix),
    )


def _index(problem: MotionProblem, name: str) -> int:
    return 1 + [sign.name for sign in problem.signs].index(name)


def _holding(problem: MotionProblem, name: str) -> Program:
    """Return the program of a sign that holds the motion on its surface: its one output has the sign's name."""
    index = _index(problem, name)
    program = with_numbers(computing(problem.switching, {f"drive[{index}]", f"grip[{index}]"}), {name: ZERO})
    value = Call(Operation.DIVIDE, (
        Call(Operation.NEGATE, (program.outputs[f"drive[{index}]"],)), program.outputs[f"grip[{index}]"],
    ))  # fmt: skip
    return replace(program, assignments=(*program.assignments, (name, value)), outputs={name: Name(name)})


def _preceded(first: Program, program: Program) -> Program:
    """Return a program after another one has computed one of its inputs; both take the same inputs otherwise."""
    (sign,) = first.outputs
    taken = {name for name, _ in program.assignments} | set(program.inputs)
    own = {name: _untaken(f"{sign}_{name}", taken) for name, _ in first.assignments if name != sign}
    names: dict[str, Expression] = {name: Name(renamed) for name, renamed in own.items()}
    before = tuple((own.get(name, name), _substituted(value, names)) for name, value in first.assignments)
    joined = replace(
        program,
        inputs=tuple(name for name in program.inputs if name != sign),
        assignments=(*before, *program.assignments),
    )
    return replace(joined, operations=count_operations(joined))


def _untaken(name: str, taken: set[str]) -> str:
    return _untaken(f"{name}_", taken) if name in taken else name


def _substituted(expression: Expression, known: Mapping[str, Expression]) -> Expression:
    match expression:
        case Name(text):
            return known.get(text, expression)
        case Call(Operation.MULTIPLY, arguments) if _vanishing_weight(arguments, known):
            return ZERO
        case Call(operation, arguments) if any(name in known for name in _names_met(expression)):
            return folded(operation, [_substituted(argument, known) for argument in arguments])
        case _:
            return expression


def _vanishing_weight(arguments: tuple[Expression, ...], known: Mapping[str, Expression]) -> bool:
    """Return True if a factor made of signs alone is zero: of a law in many pieces all terms but one are told by it."""
    for each in arguments:
        of_signs = isinstance(each, Call) and all(name in known for name in _names_met(each))
        if of_signs and _substituted(each, known) == ZERO:
            return True
    return False


def _names_met(expression: Expression) -> Iterator[str]:
    """Yield names in an expression one after another: whoever has seen enough stops here."""
    match expression:
        case Name(text):
            yield text
        case Call(_, arguments):
            for argument in arguments:
                yield from _names_met(argument)
