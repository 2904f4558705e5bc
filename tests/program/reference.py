"""Programs carried out with fifty digits, and how far a computation in doubles may be from that.

The bound is a running error analysis (Higham, Accuracy and Stability of Numerical Algorithms, section 3.3): each
operation adds a few units in the last place of its result, and carries on the errors of its arguments as its
derivatives say, to first order.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from mpmath import mp, mpf

from holonom.program.arithmetic import Arithmetic, run_program
from holonom.program.motion_program import CALLED, Constant, Operation, Program

DIGITS = 50
ULP = mpf(2) ** -53
LIBRARY = 4  # units in the last place: the worst that NumPy, the C library and LLVM state of their functions
TRUSTED = mpf("1e-6")  # relative errors beyond it are outside of an analysis to first order
LARGEST = mpf("1e300")  # beyond are no doubles
FIRST_ORDER = 2  # what the neglected orders may add

FUNCTIONS = {Operation(each.head): each.of(mp) for each in CALLED} | {
    Operation.SUBTRACT: lambda a, b: a - b,
    Operation.DIVIDE: lambda a, b: a / b,
    Operation.NEGATE: lambda a: -a,
    Operation.POWER: mp.power,
}


class IllConditioned(ArithmeticError):
    """The program's values, or their errors, are not bounded at this point."""


@dataclass(frozen=True)
class Bounded:
    """A value, and a bound on the error that doubles make in it."""

    value: mpf
    error: mpf


def reference(program: Program, inputs: Sequence[float]) -> dict[str, Bounded]:
    """Values of a program's outputs at one point, with the errors that doubles may have there."""
    with mp.workdps(DIGITS):
        exact = {name: Bounded(mpf(value), mpf(0)) for name, value in zip(program.inputs, inputs, strict=True)}
        return run_program(program, exact, BOUNDED)


def assert_within_bounds(form: str, expected: Mapping[str, Bounded], computed: Sequence[float]) -> None:
    """Each computed value is a double's rounding errors away from the exact one, no more."""
    for (name, bounded), value in zip(expected.items(), computed, strict=True):
        deviation = abs(mpf(float(value)) - bounded.value)
        assert deviation <= FIRST_ORDER * bounded.error, f"{form}: {name} = {value} instead of {bounded}"


def _number(value: object) -> Bounded:
    exact = mpf(value.numerator) / value.denominator
    return Bounded(exact, ULP * abs(exact))


def _add(*terms: Bounded) -> Bounded:
    """A sum in any order."""
    rounding = ULP * len(terms) * mp.fsum(abs(term.value) for term in terms)
    return _trusted(mp.fsum(term.value for term in terms), mp.fsum(term.error for term in terms) + rounding)


def _multiply(*factors: Bounded) -> Bounded:
    product = mp.fprod(factor.value for factor in factors)
    carried = mp.fsum(
        factor.error * abs(mp.fprod(other.value for j, other in enumerate(factors) if j != i))
        for i, factor in enumerate(factors)
    )
    return _trusted(product, carried + ULP * len(factors) * abs(product))


def _apply(function: Callable[..., mpf], *arguments: Bounded) -> Bounded:
    values = [argument.value for argument in arguments]
    value = function(*values)
    carried = mp.fsum(
        argument.error * abs(mp.diff(lambda x, i=i: function(*values[:i], x, *values[i + 1 :]), argument.value))
        for i, argument in enumerate(arguments)
        if argument.error
    )
    return _trusted(value, carried + LIBRARY * ULP * abs(value))


def _sign(argument: Bounded) -> Bounded:
    if abs(argument.value) <= FIRST_ORDER * argument.error:
        raise IllConditioned
    return Bounded(mp.sign(argument.value), mpf(0))


def _power(base: Bounded, exponent: object) -> Bounded:
    return _apply(lambda x: mp.power(x, mpf(exponent.numerator) / exponent.denominator), base)


def _trusted(value: mpf, error: mpf) -> Bounded:
    if not isinstance(value, mpf) or not abs(value) < LARGEST or not error <= TRUSTED * max(1, abs(value)):
        raise IllConditioned
    return Bounded(value, error)


BOUNDED = Arithmetic(
    number=_number,
    constants={Constant.PI: Bounded(+mp.pi, ULP * 4), Constant.E: Bounded(+mp.e, ULP * 4)},
    power=_power,
    operations={
        **{operation: partial(_apply, function) for operation, function in FUNCTIONS.items()},
        Operation.ADD: _add,
        Operation.MULTIPLY: _multiply,
        Operation.SIGN: _sign,
    },
)
