"""A motion program as Python source for floats, symbols and many digits.

The module with the functions (math, sympy, mpmath) is an argument. Rational numbers are exact to the digits of its
numbers.
"""

from collections.abc import Iterator
from fractions import Fraction
from functools import partial

from ...expression import infix
from ...expression.infix import Formula, Rank
from ..arithmetic import ELEMENTARY, INFIX, Arithmetic
from ..c_source import comment_text, title_of
from ..motion_program import Constant, Operation, Program
from ..templates import filled

DEFINED = {Operation.ABS: "abs", Operation.SIGN: "sign", Operation.POWER: "power"}
IN_SPAN = """
    if ({time} < {first}) == True or ({time} > {last}) == True:  # no values there; a symbol is neither
        {time} = functions.nan"""
FUNCTIONS = {operation: f"functions.{name}" for operation, name in ELEMENTARY.items()} | DEFINED


def write(program: Program) -> str:
    """Write a program as a Python module with the function ``motion``.

    Parameters
    ----------
    program : Program

    Returns
    -------
    str
        Source text. It needs only the standard library.
    """
    variables = {known: infix.atom(f"v{index}") for index, known in enumerate(_names(program))}
    return filled(
        "motion.py.txt",
        title=comment_text(title_of(program)),
        inputs=_listed(program.inputs),
        outputs=_listed(tuple(program.outputs)),
        variables=" ".join(f"{variables[known].text}," for known in program.inputs),
        in_span="" if program.law_span is None else _in_span(program, variables["t"]),
        body="\n".join(
            f"    {variables[known].text} = {PYTHON.value(expression, variables).text}"
            for known, expression in program.assignments
        ),
        results=", ".join(PYTHON.atom(value, variables).text for value in program.outputs.values()),
    )


def _in_span(program: Program, time: Formula) -> str:
    first, last = program.times
    return IN_SPAN.format(time=time.text, first=first, last=last)


def _names(program: Program) -> Iterator[str]:
    yield from program.inputs
    yield from (name for name, _ in program.assignments)


def _listed(names: tuple[str, ...]) -> str:
    return "\n".join(f"    {name!a}," for name in names)


def _number(value: Fraction) -> Formula:
    if value.denominator == 1:
        return infix.signed(str(value.numerator))
    return infix.atom(f"ratio({value.numerator}, {value.denominator})")


def _power(base: Formula, exponent: Fraction) -> Formula:
    if exponent.denominator != 1:
        return infix.call("power", base, _number(exponent))
    return Formula(f"{base.within(Rank.ATOM)}**{_number(exponent).within(Rank.SIGNED)}", Rank.POWER)


PYTHON = Arithmetic(
    number=_number,
    constants={Constant.PI: infix.atom("functions.pi"), Constant.E: infix.atom("functions.exp(1)")},
    power=_power,
    operations={
        **{operation: partial(infix.call, function) for operation, function in FUNCTIONS.items()},
        **INFIX,
    },
)
