"""A motion program as C99 source, for one point and for many.

Assigned names are replaced by v0, v1, ..., those of the inputs of one point by their places in the arrays, which the
opening comment lists.
Many points are taken several at a time, as lanes of one vector, where the compiler knows GNU C's vectors. Left to find
the lanes itself in a loop over the points, GCC 12 finds none. With vectorization forced, it takes four times as long to
compile.
"""

import json
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from math import e, pi
from textwrap import indent

from ..expression import infix
from ..expression.infix import Formula
from .arithmetic import ELEMENTARY, INFIX, Arithmetic
from .motion_program import BINARY, Constant, Name, Operation, Program, names_in, names_used
from .templates import filled, template

FUNCTIONS = ELEMENTARY | {Operation.ABS: "fabs"}

# Assignments in one function of C: GCC's time at -O2 grows as the square of its length.
LONGEST = 500  # that is left whole
PIECE = 100  # in each function that a longer one is divided into

HELPERS = """\
static inline double square(double x) { return x*x; }
static inline double cube(double x) { return x*x*x; }
static inline double sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : x; }"""
IN_SPAN = "in_span"  # of the time, if functions of it have a span: nan outside
NOT_INLINE = """\
#if !defined PIECE && defined __GNUC__
#define PIECE static __attribute__((noinline))
#elif !defined PIECE
#define PIECE static
#endif
"""
ROOTS_AND_POWERS = {Fraction(1, 2): "sqrt", Fraction(2): "square", Fraction(3): "cube"}
MULTIPLIED_OUT = range(4, 17)  # exponents for which a few squares and cubes are sooner done than pow

LANE_FUNCTIONS = {
    1: "static inline lanes lanes_{0}(lanes a) {{ EACH_LANE(y, {0}(LANE(a, k))); }}",
    2: "static inline lanes lanes_{0}(lanes a, lanes b) {{ EACH_LANE(y, {0}(LANE(a, k), LANE(b, k))); }}",
}


@dataclass(frozen=True)
class Target:
    """The form of statements, formulas and numbers in C or a similar language."""

    statement: str
    arithmetic: Arithmetic[Formula]
    type: str = "double"
    prefix: str = ""  # of the names of functions
    reads_in_place: bool = False  # formulas contain the inputs' expressions, rather than names of copies


def c_source(program: Program) -> str:
    """Return a program as C99, ``motion`` and ``motion_batch``.

    Parameters
    ----------
    program : Program

    Returns
    -------
    str
        A translation unit that needs the standard library alone.
    """
    inputs, outputs = range(len(program.inputs)), range(len(program.outputs))
    reads, writes = [f"in[{place}]" for place in inputs], [f"out[{place}] = {{value}};" for place in outputs]
    one = in_pieces(program, ONE, reads, writes, "motion", "const double *in, double *out")
    reads = [f"lanes_at(in + {place}*points + i)" for place in inputs]
    writes = [f"put_lanes(out + {place}*points + i, {{value}});" for place in outputs]
    parameters = "size_t points, size_t i, const double *in, double *out"
    many = in_pieces(program, MANY, reads, writes, "motion_batch", parameters)
    return filled(
        "motion.c",
        title=comment_text(title_of(program)),
        table="\n".join(_table(program)),
        helpers=helpers_of(program),
        pieces=one.functions,
        one=indent(one.body, " " * 4),
        lanes=batch_support(many),
        many=indent(many.body, " " * 8),
        inputs=len(program.inputs),
        outputs=len(program.outputs),
    )


def helpers_of(program: Program) -> str:
    """Return the functions of C that statements for one point need.

    Parameters
    ----------
    program : Program

    Returns
    -------
    str
        `HELPERS`, and the span of the functions of time.
    """
    if program.law_span is None:
        return HELPERS
    first, last = program.times
    return f"{HELPERS}\nstatic inline double {IN_SPAN}(double t) {{ return t >= {first} && t <= {last} ? t : NAN; }}"


def scalar_statements(program: Program, inputs: Sequence[str]) -> Iterator[str]:
    """Return the program for one point, as statements of C that fill an array ``out``.

    The statements need `HELPERS` and the mathematical functions.

    Parameters
    ----------
    program : Program
    inputs : sequence of str
        Expression of C for each input.

    Returns
    -------
    iterator of str
        One statement for each item.
    """
    return statements(program, ONE, inputs, [f"out[{place}] = {{value}};" for place in range(len(program.outputs))])


def title_of(program: Program) -> str:
    """Return a one-line description of the program.

    Parameters
    ----------
    program : Program

    Returns
    -------
    str
        Scene, number of operations, method of the solve, range, and the times for which functions have values.
    """
    scene = f" of {program.scene}" if program.scene else ""
    operations = f"{program.operations} operations, {program.solve} solve ({program.method})"
    span = "" if program.law_span is None else ", from t = {:.10g} to {:.10g}".format(*map(float, program.law_span))
    return f"Motion program{scene}: {operations}{_redundancy(program)}; {range_of(program)}{span}"


def range_of(program: Program) -> str:
    """Return the states at which no pivot of the program vanishes.

    Parameters
    ----------
    program : Program

    Returns
    -------
    str
        A clause that begins with "valid where".
    """
    if program.method == "supported":
        return "valid where forces and constraints determine the motion, if the rank of the mass matrix is constant"
    return (
        "valid where the constraints are independent and the mass matrix, apart from massless coordinates, is positive "
        "definite"
    )


def _redundancy(program: Program) -> str:
    names = program.redundant
    are, whose = ("are", "whose constraints follow") if len(names) > 1 else ("is", "whose constraint follows")
    return f"; {', '.join(names)} {are} put to zero, {whose} from the others" if names else ""


def comment_text(text: str) -> str:
    """Escape text for a comment, by JSON's escapes without the quotes.

    The result cannot begin or end a comment.

    Parameters
    ----------
    text : str
        Any text.

    Returns
    -------
    str
        Text without characters beyond ASCII and without begin or end of a comment.
    """
    return json.dumps(text)[1:-1].replace("*/", "*\\/").replace("/*", "/\\*")


def _table(program: Program) -> Iterator[str]:
    for array, names in (("in", program.inputs), ("out", program.outputs)):
        for index, name in enumerate(names):
            yield f"   {array}[{index}]".ljust(12) + comment_text(name)


def statements(program: Program, target: Target, inputs: Sequence[str], writes: Sequence[str]) -> Iterator[str]:
    """Yield the program as statements of C or of a language with similar formulas.

    Parameters
    ----------
    program : Program
    target : Target
        `ONE` point, or `MANY` in lanes, or another language's.
    inputs : sequence of str
        For each input an expression. Those that the program does not use are not read.
    writes : sequence of str
        For each output the statement that puts ``{value}`` where it belongs.

    Yields
    ------
    str
        One statement.
    """
    copied, names = () if target.reads_in_place else names_used(program), {}
    for index, (name, value) in enumerate(zip(program.inputs, inputs, strict=True)):
        if name == "t" and program.law_span is not None:
            value = f"{target.prefix}{IN_SPAN}({value})"
        names[name] = infix.atom(value if target.reads_in_place else f"v{index}")
        if name in copied:
            yield target.statement.format(name=f"v{index}", formula=value)
    for index, (name, expression) in enumerate(program.assignments, start=len(program.inputs)):
        formula = target.arithmetic.value(expression, names)
        names[name] = infix.atom(f"v{index}")
        yield target.statement.format(name=f"v{index}", formula=formula.text)
    for value, write in zip(program.outputs.values(), writes, strict=True):
        yield write.format(value=target.arithmetic.atom(value, names).text)


@dataclass(frozen=True)
class SourceParts:
    """Statements of a function of C, and the functions that they call."""

    functions: str
    body: str


def in_pieces(
    program: Program, target: Target, inputs: Sequence[str], writes: Sequence[str], function: str, parameters: str
) -> SourceParts:
    """Return a program as statements of C, or as calls of parts if it is long.

    Values that a later part needs are stored in an array ``w``.

    Parameters
    ----------
    program, target, inputs, writes
        As for `statements`.
    function : str
        Prefix of the names of the parts.
    parameters : str
        Parameters of the parts, by which they read the inputs and write the outputs.

    Returns
    -------
    SourceParts
    """
    if len(program.assignments) <= LONGEST:
        return SourceParts("", "\n".join(statements(program, target, inputs, writes)))
    results = list(zip(program.outputs.items(), writes, strict=True))
    parts = [*((part, []) for part in _parts(program.assignments)), *(((), part) for part in _parts(results))]
    uses = [_names_in_part(*part) for part in parts]
    last_use = {name: number for number, used in enumerate(uses) for name in used}
    given = dict(zip(program.inputs, inputs, strict=True))
    place_of: dict[str, int] = {}
    free: list[int] = []
    size, functions = 0, []
    declared, passed = f"{parameters}, {target.type} *w", ", ".join([*names_of(parameters), "w"])
    for number, (assignments, outputs) in enumerate(parts):
        stored_here = {name: f"w[{place_of[name]}]" for name in uses[number] if name in place_of}
        reads = {name: given[name] for name in uses[number] if name in given} | stored_here
        free += [place_of.pop(name) for name in stored_here if last_use[name] == number]
        stored = [name for name, _ in assignments if last_use.get(name, number) > number]
        for name in stored:
            place_of[name] = free.pop() if free else size
            size = max(size, place_of[name] + 1)
        piece = replace(
            program,
            inputs=tuple(reads),
            assignments=tuple(assignments),
            outputs={name: Name(name) for name in stored} | dict(output for output, _ in outputs),
        )
        stores = [*(f"w[{place_of[name]}] = {{value}};" for name in stored), *(write for _, write in outputs)]
        unused = _unused(names_of(declared), [*reads.values(), *stores])
        text = _indented([*unused, *statements(piece, target, list(reads.values()), stores)])
        functions.append(f"PIECE void {function}_{number}({declared})\n{{\n{text}\n}}\n\n")
    calls = (f"{function}_{number}({passed});" for number in range(len(parts)))
    return SourceParts(NOT_INLINE + "".join(functions), "\n".join([f"{target.type} w[{size}];", *calls]))


def _parts(items: Sequence) -> list[Sequence]:
    return [items[first : first + PIECE] for first in range(0, len(items), PIECE)]


def _names_in_part(assignments: Sequence, outputs: Sequence) -> list[str]:
    """Return the names that assignments and outputs use, each once, in order."""
    expressions = [*(expression for _, expression in assignments), *(value for (_, value), _ in outputs)]
    return sorted(set().union(*map(names_in, expressions)))


def names_of(parameters: str) -> list[str]:
    """Return the names in a list of declarations of C.

    Parameters
    ----------
    parameters : str
        Declarations, separated by commas.

    Returns
    -------
    list of str
    """
    return re.findall(r"(\w+)(?=,|$)", parameters)


def body_of(lines: Iterable[str], parameters: Iterable[str]) -> str:
    """Return the body of a C function, with casts to void of unused parameters.

    Parameters
    ----------
    lines : iterable of str
        Statements.
    parameters : iterable of str
        Names of the parameters.

    Returns
    -------
    str
    """
    lines = list(lines)
    return _indented([*_unused(parameters, lines), *lines])


def _unused(parameters: Iterable[str], texts: Iterable[str]) -> Iterator[str]:
    """Yield casts to void of the parameters that are in none of the texts."""
    words = set(re.findall(r"\w+", "\n".join(texts)))
    return (f"(void)({name});" for name in parameters if name not in words)


def _indented(lines: Iterable[str]) -> str:
    return ("    " + "\n".join(lines).replace("\n", "\n    ")).rstrip()


def batch_support(many: SourceParts) -> str:
    """Return the vector type and the functions that statements for `MANY` need.

    Parameters
    ----------
    many : SourceParts
        Statements for `MANY`.

    Returns
    -------
    str
        Definitions in C.
    """
    arities = {name: 2 if operation in BINARY else 1 for operation, name in FUNCTIONS.items()}
    arities |= {"pow": 2, IN_SPAN: 1}
    text = many.functions + many.body
    called = {name: arity for name, arity in arities.items() if f"lanes_{name}(" in text}
    return (
        template("lanes.h")
        + "".join(LANE_FUNCTIONS[arity].format(name) + "\n" for name, arity in called.items())
        + many.functions
    )


def _scalar(value: Fraction | float) -> Formula:
    return infix.signed(repr(float(value)))


def _lanes(value: Fraction | float) -> Formula:
    return infix.call("lanes_of", _scalar(value))


def _arithmetic(prefix: str, number: Callable[[Fraction | float], Formula]) -> Arithmetic[Formula]:
    """Return C's arithmetic for a prefix of its functions and a format of its numbers."""

    def power(base: Formula, exponent: Fraction) -> Formula:
        if (function := ROOTS_AND_POWERS.get(exponent)) is not None:
            return infix.call(prefix + function, base)
        if exponent < 0:
            return infix.divide(number(1.0), power(base, -exponent))
        if exponent == 1:
            return base
        for step in (2, 3):
            if exponent in MULTIPLIED_OUT and exponent % step == 0:
                return power(power(base, exponent / step), Fraction(step))
        return infix.call(f"{prefix}pow", base, number(exponent))

    return Arithmetic(
        number=number,
        constants={Constant.PI: number(pi), Constant.E: number(e)},
        power=power,
        operations={
            **{operation: partial(infix.call, prefix + function) for operation, function in FUNCTIONS.items()},
            **INFIX,
            Operation.POWER: partial(infix.call, f"{prefix}pow"),
        },
    )


ONE = Target("const double {name} = {formula};", _arithmetic("", _scalar), reads_in_place=True)
MANY = Target("const lanes {name} = {formula};", _arithmetic("lanes_", _lanes), "lanes", "lanes_")
