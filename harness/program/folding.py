"""Operations on numbers in programs, done when the program is written."""

from fractions import Fraction

from .motion_program import Call, Expression, Operation

ZERO, ONE = Fraction(0), Fraction(1)


def folded(operation: Operation, arguments: list[Expression]) -> Expression:
    """Return the operation on its arguments, evaluated if all are numbers.

    Parameters
    ----------
    operation : Operation
    arguments : list of Expression
        Arguments, themselves folded.

    Returns
    -------
    Expression
        A number, an argument, or the call.
    """
    match operation, arguments:
        case Operation.ADD, _:
            return _collected(operation, arguments, ZERO)
        case Operation.MULTIPLY, _:
            return ZERO if ZERO in arguments else _collected(operation, arguments, ONE)
        case Operation.NEGATE, [Fraction() as a]:
            return -a
        case Operation.SUBTRACT, [Fraction() as a, Fraction() as b]:
            return a - b
        case Operation.SUBTRACT, [a, Fraction(numerator=0)]:
            return a
        case Operation.SUBTRACT, [Fraction(numerator=0), b]:
            return Call(Operation.NEGATE, (b,))
        case Operation.DIVIDE, [Fraction() as a, Fraction() as b] if b:
            return a / b
        case Operation.DIVIDE, [Fraction(numerator=0), _]:
            return ZERO
        case Operation.POWER, [Fraction() as a, Fraction(denominator=1) as n] if a or n >= 0:
            return a ** int(n)
        case _:
            return Call(operation, tuple(arguments))


def _collected(operation: Operation, arguments: list[Expression], neutral: Fraction) -> Expression:
    """Return a sum or product with its numbers taken together."""
    number, rest = neutral, []
    for argument in arguments:
        if isinstance(argument, Fraction):
            number = number + argument if operation is Operation.ADD else number * argument
        else:
            rest.append(argument)
    if not rest:
        return number
    parts = rest if number == neutral else [number, *rest]
    return parts[0] if len(parts) == 1 else Call(operation, tuple(parts))
