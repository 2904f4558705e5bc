"""Evaluate expressions and their gradients along a motion, by the reverse mode.

The trees of a description become one list of operations with common subexpressions shared. Every number is a Taylor
polynomial in the time. The cost of all derivatives together is a small multiple of that of the values (Griewank &
Walther, Evaluating Derivatives, chapter 3).
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache, partial
from heapq import heapify, heappop, heappush

from mpmath import mp

from ..expression.functions import CONSTANTS, FUNCTIONS
from ..expression.trees import Tree, converted, integer, refusal
from .irregular_point import IrregularPoint
from .taylor import Polynomial, Taylor

OF_THE_TABLE = {each.head: each for each in FUNCTIONS if each.slope}
REMEMBERED = 2**12  # Taylor coefficients of functions at numbers
RELATIONS = {"Greater": 1, "GreaterEqual": 1, "Less": -1, "LessEqual": -1}

Operation = tuple[str, tuple[int, ...]]


class Tape:
    """A list of operations, in the order in which they can be computed."""

    def __init__(self) -> None:
        self.operations: list[Operation] = []
        self.names: dict[str, int] = {}  # places of the quantities that they begin with
        self.numbers: dict[int, Fraction] = {}
        self._places: dict[object, int] = {}
        self._named: dict[int, str] = {}  # names by their places

    def place(self, tree: Tree) -> int:
        """Return the place of an expression, added if necessary.

        Parameters
        ----------
        tree : Tree
            The expression.

        Returns
        -------
        int

        Raises
        ------
        HolonomError
            It is not an expression.
        """
        return converted(tree, self._expanded)

    def _expanded(self, tree: Tree) -> tuple[object, list[Tree]]:
        match tree:
            case ["Rational", numerator, denominator]:
                return partial(self._number, Fraction(integer(numerator), integer(denominator))), []
            case {"num": str(digits)}:
                return partial(self._number, Fraction(digits)), []
            case bool():
                raise refusal(tree)
            case int():
                return partial(self._number, Fraction(tree)), []
            case str():
                return partial(self._name, tree), []
            case ["Sqrt", base]:
                return partial(self._added, "Power"), [base, ["Rational", 1, 2]]
            case ["Table", *_]:
                raise refusal(tree)
            case [str(head), *arguments]:
                return partial(self._added, head), arguments
            case _:
                raise refusal(tree)

    def _number(self, number: Fraction) -> int:
        place = self._added("number", number.numerator, number.denominator)
        self.numbers[place] = number
        return place

    def _name(self, name: str) -> int:
        place = self._added("name", name)
        self.names[name], self._named[place] = place, name
        return place

    def _added(self, head: str, *arguments: object) -> int:
        key = (head, *arguments)
        if key not in self._places:
            self._places[key] = len(self.operations)
            own = () if head in ("name", "number") else arguments
            self.operations.append((head, own))
        return self._places[key]

    def needed_for(self, places: Iterable[int]) -> set[int]:
        """Return the operations that some places depend on, those places included.

        Parameters
        ----------
        places : iterable of int
            Places of operations.

        Returns
        -------
        set of int
            Places of operations.
        """
        needed: set[int] = set()
        waiting = [*places]
        while waiting:
            place = waiting.pop()
            if place not in needed:
                needed.add(place)
                waiting += self.operations[place][1]
        return needed

    def values(
        self, taylor: Taylor, known: Mapping[str, Polynomial], needed: Container[int] | None = None
    ) -> list[Polynomial]:
        """Return values of all operations, or of those that are needed.

        Parameters
        ----------
        taylor : Taylor
            Arithmetic up to the order of the polynomials.
        known : mapping of str to Polynomial
            Polynomial of each name.
        needed : container of int or None
            Places to evaluate, or None for all.

        Returns
        -------
        list of Polynomial
            Polynomial at each place, empty if it is not needed.

        Raises
        ------
        IrregularPoint
            One of them has no finite real value, or changes its form at the time.
        """
        values: list[Polynomial] = [()] * len(self.operations)
        for name, place in self.names.items():
            if needed is None or place in needed:
                values[place] = _quantity(name, known)
        for place, number in self.numbers.items():
            values[place] = (mp.mpf(number.numerator) / number.denominator,)
        for place, (head, arguments) in enumerate(self.operations):
            if head not in ("name", "number") and (needed is None or place in needed):
                values[place] = value_of(taylor, head, [values[each] for each in arguments])
        return values

    def sizes(
        self, taylor: Taylor, values: Sequence[Polynomial], needed: Container[int] | None = None
    ) -> list[Polynomial]:
        """Return the sums of the sizes of all terms, for each operation.

        Parameters
        ----------
        taylor : Taylor
            Arithmetic up to the order of the polynomials.
        values : sequence of Polynomial
            Result of `values`.
        needed : container of int or None
            Places to evaluate, as for `values`, or None for all.

        Returns
        -------
        list of Polynomial
            Polynomial at each place, empty if it is not needed.
        """
        found: list[Polynomial] = []
        for place, (head, arguments) in enumerate(self.operations):
            x = [found[each] for each in arguments]
            match head:
                case _ if needed is not None and place not in needed:
                    found.append(())
                case "Add" | "Subtract":
                    found.append(taylor.add(*x))
                case "Multiply":
                    found.append(_product(taylor, x))
                case "Negate":
                    found.append(x[0])
                case "Power" if self._is_small_power(arguments[1]):
                    found.append(taylor.power(x[0], values[arguments[1]][0]))
                case _:
                    found.append(tuple(map(abs, values[place])))
        return found

    def _is_small_power(self, place: int) -> bool:
        return place in self.numbers and self.numbers[place] in (2, 3, 4)

    def gradient(
        self, taylor: Taylor, values: Sequence[Polynomial], seeds: Mapping[int, Polynomial]
    ) -> dict[str, Polynomial]:
        """Return the gradient, by name, of the weighted sum of some places.

        Parameters
        ----------
        taylor : Taylor
            Arithmetic up to the order of the polynomials.
        values : sequence of Polynomial
            Result of `values`.
        seeds : mapping of int to Polynomial
            Weight of each place in the sum.

        Returns
        -------
        dict of str to Polynomial
            Derivative by each name that the sum depends on.
        """
        adjoints = dict(seeds)
        waiting = [-place for place in adjoints]  # the last first: it is an argument of none before
        heapify(waiting)
        while waiting:
            place = -heappop(waiting)
            head, arguments = self.operations[place]
            shares = _shares(taylor, head, arguments, values, place, adjoints[place]) if arguments else ()
            for each, share in zip(arguments, shares, strict=True):
                if share is None:
                    continue
                if each not in adjoints:
                    heappush(waiting, -each)
                adjoints[each] = taylor.add(adjoints[each], share) if each in adjoints else share
        return {self._named[place]: adjoint for place, adjoint in adjoints.items() if place in self._named}


def _quantity(name: str, known: Mapping[str, Polynomial]) -> Polynomial:
    if name in CONSTANTS and CONSTANTS[name].mpmath:
        return (+getattr(mp, CONSTANTS[name].mpmath),)
    if name in ("True", "False"):
        return (mp.mpf(1 if name == "True" else -1),)
    if name not in known:
        raise refusal(name)
    return known[name]


def value_of(taylor: Taylor, head: str, x: Sequence[Polynomial]) -> Polynomial:
    """Return the value of one operation.

    Parameters
    ----------
    taylor : Taylor
        Arithmetic up to the order of the polynomials.
    head : str
        Head of the operation's tree.
    x : sequence of Polynomial
        Values of its arguments.

    Returns
    -------
    Polynomial

    Raises
    ------
    IrregularPoint
        The operation has no finite real value, or changes its form at the time.
    """
    match head, x:
        case "Add", _:
            return taylor.add(*x)
        case "Multiply", _:
            return _product(taylor, x)
        case "Negate", [a]:
            return taylor.scale(-1, a)
        case "Subtract", [a, b]:
            return taylor.add(a, taylor.scale(-1, b))
        case "Divide", [a, b]:
            return taylor.divide(a, b)
        case "Power", [a, b] if len(b) == 1:
            return taylor.power(a, b[0])
        case "Power", [a, b]:
            return value_of(taylor, "Exp", [taylor.multiply(b, value_of(taylor, "Ln", [a]))])
        case "Sqrt", [a]:
            return taylor.power(a, mp.mpf(1) / 2)
        case "Abs", [a]:
            return taylor.scale(_sign(a), a) if any(a) else a  # zero to this order on both sides
        case "Arctan2", [a, b]:
            return _angle(taylor, a, b)
        case _ if head in OF_THE_TABLE:
            return _composed(taylor, head, x)
        case _:
            return _decided(taylor, head, x)


def _composed(taylor: Taylor, head: str, x: Sequence[Polynomial]) -> Polynomial:
    """Compose a function of the table with its argument x, the others being constant."""
    names = OF_THE_TABLE[head].arguments
    numbers = [each[0] if name == "x" else _constant(each) for name, each in zip(names, x, strict=True)]
    inner = x[names.index("x")]
    return taylor.compose(coefficients(head, mp.prec, 0 if len(inner) == 1 else taylor.order, *numbers), inner)


@lru_cache(REMEMBERED)
def coefficients(head: str, precision: int, order: int, *numbers: mp.mpf) -> Polynomial:
    """Solve the differential equation of a function for its Taylor coefficients.

    Parameters
    ----------
    head : str
        Head of the function's tree.
    precision : int
        The working precision, in bits.
    order : int
        Highest order.
    *numbers : mpf
        Arguments of the function.

    Returns
    -------
    Polynomial

    Raises
    ------
    IrregularPoint
        The function has no finite real value.
    """
    function = OF_THE_TABLE[head]
    first = function.of(mp)(*numbers)
    if not (isinstance(first, mp.mpf) and mp.isfinite(first)):
        raise IrregularPoint
    found: Polynomial = (first,)
    arguments = [(x, mp.one) if name == "x" else (x,) for name, x in zip(function.arguments, numbers, strict=True)]
    for k in range(1 if _contains(function.slope, "y") else max(order, 1), order + 1):
        found = Taylor(k).integral(_slope(Taylor(k - 1), head, arguments, found), first)
    return found


def _contains(tree: Tree, name: str) -> bool:
    return tree == name or (isinstance(tree, list) and any(_contains(each, name) for each in tree[1:]))


def _slope(taylor: Taylor, head: str, x: Sequence[Polynomial], y: Polynomial) -> Polynomial:
    """Return the derivative by x of a function with the value y."""
    function = OF_THE_TABLE[head]
    known = {**dict(zip(function.arguments, x, strict=True)), "y": y}

    def value(tree: Tree) -> Polynomial:
        match tree:
            case str():
                return _quantity(tree, known)
            case int():
                return (mp.mpf(tree),)
            case [part, *arguments]:
                return value_of(taylor, part, list(map(value, arguments)))

    return value(function.slope)


def _constant(x: Polynomial) -> mp.mpf:
    if any(x[1:]):
        raise IrregularPoint
    return x[0]


def _sign(x: Polynomial) -> int:
    """Return the sign after the time of the expansion."""
    for coefficient in x:
        if coefficient:
            return 1 if coefficient > 0 else -1
    raise IrregularPoint


def _product(taylor: Taylor, factors: Iterable[Polynomial]) -> Polynomial:
    found: Polynomial = (mp.one,)
    for each in factors:
        found = taylor.multiply(found, each)
    return found


def _angle(taylor: Taylor, y: Polynomial, x: Polynomial) -> Polynomial:
    first = mp.atan2(y[0], x[0])
    if len(x) == len(y) == 1:
        return (first,)
    turned = taylor.add(taylor.multiply(x, taylor.rate(y)), taylor.scale(-1, taylor.multiply(y, taylor.rate(x))))
    return taylor.integral(taylor.divide(turned, _squares(taylor, x, y)), first)


def _squares(taylor: Taylor, x: Polynomial, y: Polynomial) -> Polynomial:
    return taylor.add(taylor.multiply(x, x), taylor.multiply(y, y))


def _decided(taylor: Taylor, head: str, x: Sequence[Polynomial]) -> Polynomial:
    """Return the value of an operation that signs decide.

    A condition is 1 if it holds and -1 if it does not.
    """
    match head:
        case "Sign":
            return (mp.mpf(_sign(x[0])),)
        case "UnitStep" | "HalfStep":
            return (mp.mpf((1 + _sign(x[0])) // 2),)
        case "Max" | "Min":
            side, best = (1 if head == "Max" else -1), x[0]
            for other in x[1:]:
                best = other if side * _sign(taylor.add(other, taylor.scale(-1, best))) > 0 else best
            return best
        case "Which":
            return x[_chosen(x)]
        case "And" | "Or":
            return (min if head == "And" else max)(x)
        case "Not":
            return taylor.scale(-1, x[0])
        case "Equal" | "Same" | "NotEqual" | "NotSame":
            _sign(taylor.add(x[0], taylor.scale(-1, x[1])))
            return (mp.mpf(1 if head.startswith("Not") else -1),)
        case _ if head in RELATIONS:
            return (mp.mpf(RELATIONS[head] * _sign(taylor.add(x[0], taylor.scale(-1, x[1])))),)
        case _:
            raise refusal([head])


def _chosen(x: Sequence[Polynomial]) -> int:
    """Return the place of the value with a true condition.

    Conditions and values alternate.
    """
    return next(k + 1 for k in range(0, len(x), 2) if x[k][0] > 0)


def _shares(
    taylor: Taylor,
    head: str,
    arguments: Sequence[int],
    values: Sequence[Polynomial],
    place: int,
    adjoint: Polynomial,
) -> list[Polynomial | None]:
    """Return the contributions of an operation to the adjoints of its arguments."""
    x = [values[each] for each in arguments]
    match head:
        case "Add":
            return [adjoint] * len(x)
        case "Multiply":
            return _shares_of_product(taylor, x, adjoint)
        case "Negate":
            return [taylor.scale(-1, adjoint)]
        case "Subtract":
            return [adjoint, taylor.scale(-1, adjoint)]
        case "Divide":
            share = taylor.divide(adjoint, x[1])
            return [share, taylor.scale(-1, taylor.multiply(share, values[place]))]
        case "Power":
            return _shares_of_power(taylor, x, values[place], adjoint)
        case "Abs":
            return [taylor.scale(_sign(x[0]), adjoint)]
        case "Arctan2":
            share = taylor.divide(adjoint, _squares(taylor, *x))
            return [taylor.multiply(share, x[1]), taylor.scale(-1, taylor.multiply(share, x[0]))]
        case "Sign" | "UnitStep" | "HalfStep":
            return [None]
        case "Max" | "Min":
            return [adjoint if each is values[place] else None for each in x]
        case "Which":
            return [adjoint if k == _chosen(x) else None for k in range(len(x))]
    if head not in OF_THE_TABLE:
        raise refusal([head])
    share = taylor.multiply(adjoint, _slope(taylor, head, x, values[place]))
    return [share if name == "x" else None for name in OF_THE_TABLE[head].arguments]


def _shares_of_product(taylor: Taylor, x: Sequence[Polynomial], adjoint: Polynomial) -> list[Polynomial | None]:
    after: list[Polynomial] = [(mp.one,)]
    for each in reversed(x[1:]):
        after.append(taylor.multiply(each, after[-1]))
    shares, before = [], adjoint
    for each, rest in zip(x, reversed(after), strict=True):
        shares.append(taylor.multiply(before, rest))
        before = taylor.multiply(before, each)
    return shares


def _shares_of_power(
    taylor: Taylor, x: Sequence[Polynomial], value: Polynomial, adjoint: Polynomial
) -> list[Polynomial | None]:
    base, exponent = x
    share = taylor.multiply(adjoint, value)
    # the power is real for this exponent, and not for others near it
    of_exponent = None if base[0] <= 0 else taylor.multiply(share, value_of(taylor, "Ln", [base]))
    if len(exponent) > 1:
        return [taylor.divide(taylor.multiply(share, exponent), base), of_exponent]
    # no division by a base that may be zero but for rounding
    slope = taylor.scale(exponent[0], taylor.power(base, exponent[0] - 1)) if exponent[0] else (mp.zero,)
    return [taylor.multiply(adjoint, slope), of_exponent]
