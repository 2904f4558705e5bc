"""Programs made of others: parts, compositions, numbers in place of names.

Operations on numbers are done when the program is written.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import cycle

from .motion_program import Call, Constant, Expression, Name, Operation, Program, names_in

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
        case Operation.SUBTRACT, [a, b] if _weighted(a) == _weighted(b):
            return ZERO
        case Operation.SUBTRACT, [a, Fraction(numerator=0)]:
            return a
        case Operation.SUBTRACT, [Fraction(numerator=0), b]:
            return Call(Operation.NEGATE, (b,))
        case Operation.DIVIDE, [Fraction() as a, Fraction() as b] if b:
            return a / b
        case Operation.DIVIDE, [Fraction(numerator=0), _]:
            return ZERO
        case Operation.DIVIDE, [a, Fraction(numerator=1, denominator=1)]:
            return a
        case Operation.POWER, [Fraction() as a, Fraction(denominator=1) as n] if a or n >= 0:
            return a ** int(n)
        case Operation.POWER, [Fraction(numerator=0), Fraction() as n] if n > 0:
            return ZERO
        case Operation.SQRT, [Fraction(numerator=0)]:
            return ZERO
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
    if operation is Operation.ADD:
        rest = _without_cancelled(rest)
    if not rest:
        return number
    parts = rest if number == neutral else [number, *rest]
    return parts[0] if len(parts) == 1 else Call(operation, tuple(parts))


def _without_cancelled(terms: list[Expression]) -> list[Expression]:
    """Return a sum's terms that do not cancel: none of s*x + x for s = -1."""
    weighted = list(map(_weighted, terms))
    if all(weight > 0 for weight, _ in weighted):
        return terms
    weights: dict[Expression, Fraction] = {}
    for weight, part in weighted:
        weights[part] = weights.get(part, ZERO) + weight
    return [term for term, (_, part) in zip(terms, weighted, strict=True) if weights[part]]


def _weighted(term: Expression) -> tuple[Fraction, Expression]:
    """Return the number before a term, and the term without it."""
    match term:
        case Call(Operation.NEGATE, (part,)):
            return -ONE, part
        case Call(Operation.MULTIPLY, (Fraction() as weight, part)):
            return weight, part
        case _:
            return ONE, term


def computing(program: Program, wanted: Collection[str]) -> Program:
    """Return the part of a program that computes some of its outputs.

    It has the same inputs.

    Parameters
    ----------
    program : Program
    wanted : collection of str
        Names of the selected outputs.

    Returns
    -------
    Program
        Program with the assignments that these outputs need.
    """
    outputs = {name: value for name, value in program.outputs.items() if name in wanted}
    needed = set().union(*map(names_in, outputs.values()))
    assignments = []
    for name, expression in reversed(program.assignments):
        if name in needed:
            assignments.append((name, expression))
            needed |= names_in(expression)
    return replace(program, outputs=outputs, assignments=tuple(reversed(assignments)))


def with_numbers(program: Program, numbers: Mapping[str, Fraction]) -> Program:
    """Return a program with numbers for some of its inputs, without zero products.

    Parameters
    ----------
    program : Program
    numbers : mapping of str to Fraction
        Values of inputs, by name.

    Returns
    -------
    Program
        Program without these inputs.
    """
    known: dict[str, Expression] = dict(numbers)
    assignments = []
    for name, expression in program.assignments:
        value = _substituted(expression, known)
        assignments.append((name, value))
        if isinstance(value, Fraction | Name | Constant):
            known[name] = value
    part = replace(
        program,
        inputs=tuple(name for name in program.inputs if name not in numbers),
        assignments=tuple(assignments),
        outputs={name: _substituted(value, known) for name, value in program.outputs.items()},
    )
    return computing(part, part.outputs)


def with_calls(program: Program, known: Mapping[Call, Expression]) -> Program:
    """Return a program with other expressions in place of some operations.

    Parameters
    ----------
    program : Program
    known : mapping of Call to Expression
        What replaces an operation. Operations in it are replaced, too.

    Returns
    -------
    Program
        The same inputs and outputs.
    """

    def written(expression: Expression) -> Expression:
        expression = known.get(expression, expression) if isinstance(expression, Call) else expression
        if isinstance(expression, Call):
            return Call(expression.operation, tuple(map(written, expression.arguments)))
        return expression

    return replace(program, assignments=tuple((name, written(value)) for name, value in program.assignments))


def with_names_for_numbers(expression: Expression, start: str) -> tuple[Expression, dict[str, Fraction]]:
    """Return an expression with a name for each of its numbers, exponents apart.

    Parameters
    ----------
    expression : Expression
    start : str
        Start of the names. They end with 0, 1, ...

    Returns
    -------
    (Expression, dict of str to Fraction)
        The expression, and the numbers by name.
    """
    numbers: dict[str, Fraction] = {}

    def named(part: Expression) -> Expression:
        match part:
            case Fraction():
                name = f"{start}{len(numbers)}"
                numbers[name] = part
                return Name(name)
            case Call(Operation.POWER, (base, exponent)):
                return Call(Operation.POWER, (named(base), exponent))
            case Call(operation, arguments):
                return Call(operation, tuple(map(named, arguments)))
            case _:
                return part

    return named(expression), numbers


def preceded(first: Program, program: Program) -> Program:
    """Return a program after another one that computes some of its inputs.

    Both take the same inputs otherwise.

    Parameters
    ----------
    first : Program
        Program whose outputs have the names of these inputs, each that of the value itself.
    program : Program

    Returns
    -------
    Program
        Program without these inputs.
    """
    computed = first.outputs.keys()
    taken = {name for name, _ in program.assignments} | set(program.inputs)
    own = {
        name: untaken(f"{next(iter(computed))}_{name}", taken) for name, _ in first.assignments if name not in computed
    }
    names: dict[str, Expression] = {name: Name(renamed) for name, renamed in own.items()}
    before = tuple((own.get(name, name), _substituted(value, names)) for name, value in first.assignments)
    return replace(
        program,
        inputs=tuple(name for name in program.inputs if name not in computed),
        assignments=(*before, *program.assignments),
    )


def untaken(name: str, taken: Collection[str]) -> str:
    """Return a name with underscores behind it until it is free.

    Parameters
    ----------
    name : str
    taken : collection of str
        Names in use.

    Returns
    -------
    str
    """
    return untaken(f"{name}_", taken) if name in taken else name


def _substituted(expression: Expression, known: Mapping[str, Expression]) -> Expression:
    match expression:
        case Name(text):
            return known.get(text, expression)
        case Call(operation, arguments) if not known.keys().isdisjoint(expression.names):
            values = [_substituted(each, known) if _is_weight(each, operation, known) else None for each in arguments]
            if ZERO in values:  # all terms but one of a law in many parts
                return ZERO
            found = zip(arguments, values, strict=True)
            return folded(operation, [_substituted(each, known) if value is None else value for each, value in found])
        case _:
            return expression


def _is_weight(factor: Expression, operation: Operation, known: Mapping[str, Expression]) -> bool:
    """Return True for a factor made of known names alone."""
    return operation is Operation.MULTIPLY and isinstance(factor, Call) and factor.names <= known.keys()


def with_factors(program: Program, factors: Sequence[str]) -> Program:
    """Return a program with a factor at each name, rounded number and operation.

    If the factors are random and near one, they do as rounding errors.

    Parameters
    ----------
    program : Program
    factors : sequence of str
        Names of further inputs, which are used in turn.

    Returns
    -------
    Program
    """
    names = cycle(factors)

    def times_factor(expression: Expression) -> Expression:
        return Call(Operation.MULTIPLY, (expression, Name(next(names))))

    def written(expression: Expression) -> Expression:
        match expression:
            case Call(Operation.POWER, (base, Fraction() as exponent)):
                return times_factor(Call(Operation.POWER, (written(base), exponent)))
            case Call(operation, arguments):
                return times_factor(Call(operation, tuple(map(written, arguments))))
            case Fraction() if Fraction(float(expression)) == expression:
                return expression
        return times_factor(expression)

    assignments = tuple((name, written(each)) for name, each in program.assignments)
    return replace(program, inputs=(*program.inputs, *factors), assignments=assignments)


def with_joined_roots(program: Program) -> Program:
    """Return a program with a^(n + 1/2) for products of a^n and sqrt(a).

    It has a derivative at zero, where that of sqrt(a) is infinite.

    Parameters
    ----------
    program : Program

    Returns
    -------
    Program
    """
    roots: dict[str, Expression] = {}  # by the names of the assignments that are one, perhaps with a divisor
    assignments = []
    for name, expression in program.assignments:
        written = _with_joined_roots(expression, roots)
        if _root_of(written) is not None:
            roots[name] = written
        assignments.append((name, written))
    return computing(replace(program, assignments=tuple(assignments)), program.outputs)


def _with_joined_roots(expression: Expression, roots: Mapping[str, Expression]) -> Expression:
    match expression:
        case Call(Operation.MULTIPLY):
            return _joined([_with_joined_roots(each, roots) for each in _factors(expression)], roots)
        case Call(operation, arguments):
            return Call(operation, tuple(_with_joined_roots(each, roots) for each in arguments))
    return expression


def _factors(expression: Expression) -> list[Expression]:
    match expression:
        case Call(Operation.MULTIPLY, arguments):
            return [factor for argument in arguments for factor in _factors(argument)]
    return [expression]


def _root_of(expression: Expression) -> Expression | None:
    """Return a of sqrt(a) or sqrt(a)/b, or None."""
    match expression:
        case Call(Operation.SQRT, (Name() | Call() as base,)) | Call(
            Operation.DIVIDE, (Call(Operation.SQRT, (Name() | Call() as base,)), _)
        ):
            return base
    return None


def _joined(factors: list[Expression], roots: Mapping[str, Expression]) -> Expression:
    """Return the product of factors, with powers for roots and what they are roots of."""
    for factor in list(factors):
        root = roots.get(factor.text, factor) if isinstance(factor, Name) else factor
        base = _root_of(root)
        exponents = {
            power: exponent
            for power, exponent in ((each, _exponent_of(each, base)) for each in factors)
            if exponent is not None and exponent > 0
        }
        if base is None or not exponents:
            continue
        power, exponent = next(iter(exponents.items()))
        factors[factors.index(power)] = Call(Operation.POWER, (base, exponent + Fraction(1, 2)))
        if root.operation is Operation.DIVIDE:
            factors[factors.index(factor)] = Call(Operation.DIVIDE, (ONE, root.arguments[1]))
        else:
            factors.remove(factor)
    return factors[0] if len(factors) == 1 else Call(Operation.MULTIPLY, tuple(factors))


def _exponent_of(expression: Expression, base: Expression | None) -> Fraction | None:
    """Return n of base^n, or None."""
    match expression:
        case Call(Operation.POWER, (other, Fraction() as exponent)) if other == base:
            return exponent
    return ONE if expression == base else None
