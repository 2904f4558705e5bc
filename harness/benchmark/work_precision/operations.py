"""Number of operations of an expansion, by the order of its coefficients.

A sum takes one operation a coefficient. A product of two series takes 2n + 1 for its coefficient of order n. So do a
quotient, a power and each function of a series. A sine takes twice as much, because it needs its cosine. A constant
takes none, and multiplication of a series by a constant takes one operation a coefficient.

References
----------
Griewank & Walther, Evaluating Derivatives, section 13.2.
"""

from collections.abc import Set
from fractions import Fraction

from ...program.motion_program import Call, Constant, Expression, Name, Operation, Program

PAIRED = frozenset({Operation.SIN, Operation.COS, Operation.SINH, Operation.COSH, Operation.TAN, Operation.TANH})
LINEAR = frozenset({Operation.ADD, Operation.SUBTRACT, Operation.NEGATE, Operation.ABS, Operation.SIGN})


def expansion_operations(program: Program, order: int) -> int:
    """Return the number of operations of an expansion to an order.

    Parameters
    ----------
    program : Program
        Program to expand.
    order : int
        Highest power of the time.

    Returns
    -------
    int
    """
    numbers: set[str] = set()
    linear = products = 0
    for name, expression in program.assignments:
        if _is_number(expression, numbers):
            numbers.add(name)
            continue
        sums, convolutions = _operations(expression, numbers)
        linear, products = linear + sums, products + convolutions
    return linear * (order + 1) + products * (order + 1) ** 2


def _operations(expression: Expression, numbers: Set[str]) -> tuple[int, int]:
    """Linear operations and products of series in an expression."""
    if not isinstance(expression, Call) or _is_number(expression, numbers):
        return 0, 0
    below = [_operations(argument, numbers) for argument in expression.arguments]
    own = _own_operations(expression, numbers)
    return sum(pair[0] for pair in below) + own[0], sum(pair[1] for pair in below) + own[1]


def _own_operations(call: Call, numbers: Set[str]) -> tuple[int, int]:
    series = sum(not _is_number(argument, numbers) for argument in call.arguments)
    match call.operation:
        case operation if operation in LINEAR:
            return max(1, len(call.arguments) - 1), 0
        case Operation.MULTIPLY:
            return len(call.arguments) - series, series - 1
        case Operation.DIVIDE if _is_number(call.arguments[1], numbers):
            return 1, 0
        case operation:
            return 0, 2 if operation in PAIRED else 1


def _is_number(expression: Expression, numbers: Set[str]) -> bool:
    match expression:
        case Fraction() | Constant():
            return True
        case Name(text):
            return text in numbers
        case Call(_, arguments):
            return all(_is_number(argument, numbers) for argument in arguments)
