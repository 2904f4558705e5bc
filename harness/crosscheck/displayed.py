"""Lengths of expressions as Maxima displays them, from the trees of a record.

Maxima decides by a predicted length whether closed forms are made. It counts the displayed form: ``-x`` for
``(-1)*x``, ``x/y`` for ``x*y^(-1)``, ``sqrt(x)`` for ``x^(1/2)``. Trees hold the products and powers of the internal
form. They are converted first.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

from ..expression.trees import Tree, integer

Displayed = str | Fraction | tuple
"""A name, a number, or an application: the operator, then what it is applied to."""

HALF = Fraction(1, 2)


def displayed(tree: Tree) -> Displayed:
    """Return the form in which Maxima displays a tree.

    Parameters
    ----------
    tree : Tree
        Expression of a record.

    Returns
    -------
    Displayed
    """
    match tree:
        case str():
            return tree
        case int() | {"num": _} | ["Rational", _, _]:
            return _number(tree)
        case ["Subscript", name, *indices]:
            return f"{name}[{', '.join(map(str, indices))}]"
        case ["Multiply", ["Sign", base], ["Power", ["Abs", same], ["Rational", int(p), int(q)] as exponent]] if (
            base == same and p % 2 and q % 2
        ):
            return displayed(["Power", base, exponent])
        case ["Power", ["Abs", base], ["Rational", int(p), int(q)] as exponent] if p % 2 == 0 and q % 2:
            return displayed(["Power", base, exponent])
        case ["Multiply", *factors]:
            return _product([displayed(factor) for factor in factors])
        case ["Sqrt", base]:
            return ("sqrt", displayed(base))
        case ["Power", base, exponent]:
            return _power(displayed(base), displayed(exponent))
        case ["Exp", exponent]:
            return _power("%e", displayed(exponent))
        case [head, *arguments]:
            return (head, *map(displayed, arguments))


def size(form: Displayed) -> int:
    """Return the number of symbols, numbers and operations in a displayed form.

    Parameters
    ----------
    form : Displayed
        Displayed form.

    Returns
    -------
    int
    """
    return 1 + sum(map(size, form[1:])) if isinstance(form, tuple) else 1


def operations(form: Displayed) -> int:
    """Return the number of operations in a displayed form.

    A sum or product of k parts has k - 1.

    Parameters
    ----------
    form : Displayed
        Displayed form.

    Returns
    -------
    int
    """
    if not isinstance(form, tuple):
        return 0
    own = len(form) - 2 if form[0] in ("Add", "Multiply") else 1
    return own + sum(map(operations, form[1:]))


def roots(forms: Iterable[Displayed]) -> set[Displayed]:
    """Return the different powers with fractions for exponents in displayed forms.

    Parameters
    ----------
    forms : iterable of Displayed
        Displayed forms.

    Returns
    -------
    set of Displayed
    """
    return {part for form in forms for part in _parts(form) if _is_root(part)}


def _parts(form: Displayed) -> Iterator[Displayed]:
    yield form
    if isinstance(form, tuple):
        for part in form[1:]:
            yield from _parts(part)


def _is_root(form: Displayed) -> bool:
    match form:
        case ("sqrt", _):
            return True
        case ("Power", _, Fraction() as exponent):
            return exponent.denominator > 1
        case _:
            return False


def _number(tree: Tree) -> Fraction:
    match tree:
        case ["Rational", numerator, denominator]:
            return Fraction(integer(numerator), integer(denominator))
        case {"num": str(digits)}:
            return Fraction(digits)
        case _:
            return Fraction(tree)


def _power(base: Displayed, exponent: Displayed) -> Displayed:
    """Return a power, with a negative exponent as a denominator.

    Exponentials keep their negative exponent.
    """
    match exponent:
        case Fraction() if exponent in (HALF, -HALF):
            root = ("sqrt", base)
            return root if exponent > 0 else ("/", Fraction(1), root)
        case Fraction() if exponent < 0 and base != "%e":
            return ("/", Fraction(1), base if exponent == -1 else ("Power", base, -exponent))
        case ("-", opposite) if base != "%e":
            return ("/", Fraction(1), ("Power", base, opposite))
        case _:
            return ("Power", base, exponent)


def _product(factors: list[Displayed]) -> Displayed:
    above: list[Displayed] = []
    below: list[Displayed] = []
    negative = False
    waiting = factors[::-1]
    while waiting:
        match waiting.pop():
            case ("-", part):
                negative = not negative
                waiting.append(part)
            case Fraction() as number:
                negative ^= number < 0
                above += [Fraction(abs(number.numerator))] if abs(number.numerator) != 1 else []
                below += [Fraction(number.denominator)] if number.denominator != 1 else []
            case ("/", numerator, denominator):
                above += [numerator] if numerator != 1 else []
                below.append(denominator)
            case factor:
                above.append(factor)
    shown = _factors(above)
    if below:
        shown = ("/", shown, _factors(below))
    return ("-", shown) if negative else shown


def _factors(factors: list[Displayed]) -> Displayed:
    if len(factors) > 1:
        return ("Multiply", *factors)
    return factors[0] if factors else Fraction(1)
