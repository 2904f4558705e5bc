"""Motion programs in heyoka: expressions and dynamics.

A value that is used twice is one expression object, so heyoka recognizes shared values.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from types import ModuleType
from typing import TYPE_CHECKING, Any

from ..extras import missing_package, require_room
from ..failures import ErrorKind, HolonomError
from .arithmetic import ELEMENTARY, Arithmetic, run_program
from .motion_program import Constant, Operation, Program

if TYPE_CHECKING:
    from heyoka import expression

# Operations from which heyoka's compact mode is taken. Measured on chains: at 2000 both modes compile in the same time
# and compact code is a quarter slower; at 4000 it compiles in 60 % of the time and is as fast.
COMPACT_FROM = 3000


def heyoka_expressions(
    program: Program, inputs: Mapping[str, expression], number: Callable[[Fraction], object] = float
) -> dict[str, expression]:
    """Translate a program into heyoka's expressions, one to one.

    Parameters
    ----------
    program : Program
    inputs : mapping of str to expression
        What to put for each input: a variable, heyoka's time, a parameter, a control law.
    number : callable
        Takes a Fraction to one of heyoka's numbers. `float` is for double precision.

    Returns
    -------
    dict of str to expression
        Expression of each output.

    Raises
    ------
    HolonomError
        heyoka is not installed, or an input is missing.
    """
    if missing := [name for name in program.inputs if name not in inputs]:
        raise HolonomError(ErrorKind.INPUT_MISSING, detail=missing[0])
    return run_program(program, inputs, _arithmetic(import_heyoka(), number))


def dynamics(
    program: Program, given: Mapping[str, expression], number: Callable[[Fraction], object] = float
) -> list[tuple[expression, expression]]:
    """Return first-order equations of motion for heyoka's integrators.

    Parameters
    ----------
    program : Program
        Its outputs hold the accelerations.
    given : mapping of str to expression
        Controls, their time derivatives and accelerations as functions of `heyoka.time`, and parameters: all inputs
        other than time, coordinates and velocities.
    number : callable
        As for `heyoka_expressions`.

    Returns
    -------
    list of (expression, expression)
        Each coordinate and its velocity, then each velocity and its acceleration.

    Raises
    ------
    HolonomError
        As `heyoka_expressions`.
    """
    variables = _variables(program)
    coordinates = [name for name in program.inputs if f"ddot({name})" in program.outputs]
    velocities = [f"dot({name})" for name in coordinates]
    state = {name: variables[name] for name in (*coordinates, *velocities)}
    results = heyoka_expressions(program, {"t": import_heyoka().time, **state, **given}, number)
    return [(state[q], state[v]) for q, v in zip(coordinates, velocities, strict=True)] + [
        (state[f"dot({q})"], results[f"ddot({q})"]) for q in coordinates
    ]


def _variables(program: Program) -> dict[str, expression]:
    """Return a heyoka variable for each input."""
    return {name: import_heyoka().expression(name) for name in program.inputs}


def _arithmetic(heyoka: ModuleType, number: Callable[[Fraction], object]) -> Arithmetic[expression]:
    def constant(value: Fraction) -> expression:
        return heyoka.expression(number(value))

    def power(base: expression, exponent: Fraction) -> expression:
        if exponent.denominator == 1 and exponent > 2:  # heyoka's powers, but squares, divide by the base
            square = power(base, exponent // 2) ** constant(Fraction(2))
            return square * base if exponent % 2 else square
        return base if exponent == 1 else base ** constant(exponent)

    def sign(x: expression) -> expression:
        zero, one = constant(Fraction(0)), constant(Fraction(1))
        return heyoka.select(heyoka.gt(x, zero), one, heyoka.select(heyoka.lt(x, zero), -one, zero))

    def absolute(x: expression) -> expression:
        return heyoka.select(heyoka.lt(x, constant(Fraction(0))), -x, x)

    own = {Operation.ABS: absolute, Operation.SIGN: sign}
    return Arithmetic(
        number=constant,
        constants={Constant.PI: heyoka.pi, Constant.E: heyoka.exp(constant(Fraction(1)))},
        power=power,
        operations={
            **{operation: getattr(heyoka, name) for operation, name in ELEMENTARY.items() if operation not in own},
            **own,
            Operation.ADD: lambda *terms: heyoka.sum(list(terms)),
            Operation.MULTIPLY: lambda *factors: heyoka.prod(list(factors)),
            Operation.SUBTRACT: lambda a, b: a - b,
            Operation.DIVIDE: lambda a, b: a / b,
            Operation.NEGATE: lambda a: -a,
            Operation.POWER: lambda base, exponent: base**exponent,
        },
    )


def import_heyoka() -> ModuleType:
    """Import heyoka with its disk cache and its messages disabled.

    The disk cache would run any machine code it finds in the home directory. Altered code would give other motions. The
    messages would be written to standard output, which may contain a document. Errors are raised as exceptions.

    Returns
    -------
    ModuleType
        The package heyoka.

    Raises
    ------
    HolonomError
        heyoka is not installed.
    """
    try:
        import heyoka

        heyoka.llvm_state.set_diskcache_enabled(False)
        heyoka.set_logger_level_critical()
    except ImportError as error:
        require_room(error)
        raise missing_package("heyoka") from None
    return heyoka


def zero_multipliers(names: Iterable[str], zero: Any) -> dict[str, Any]:
    """Return zero for multipliers that are unused inputs of a program.

    Parameters
    ----------
    names : iterable of str
        Names of the multipliers.
    zero : float or heyoka number
        Zero in the precision of the program.

    Returns
    -------
    dict of str to expression
    """
    return dict.fromkeys(names, import_heyoka().expression(zero))
