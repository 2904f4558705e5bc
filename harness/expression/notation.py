"""Write MathJSON trees as one line of text, in the notation of the scene files.

Trees are those of `holonom.expression.trees`, and give the order of terms and factors. A minus sign stands once before
a term, negative powers and denominators stand once below a stroke.
"""

from collections.abc import Callable, Sequence
from decimal import Decimal

from .functions import CONSTANTS, FUNCTIONS
from .infix import Formula, Rank, atom, call
from .trees import FLOAT, INTEGER, Tree, converted, integer, quantity, refusal

WORDS = {name: each.scene for name, each in CONSTANTS.items()} | {"True": "true", "False": "false"}
BETWEEN = {
    "Greater": ">",
    "GreaterEqual": ">=",
    "Less": "<",
    "LessEqual": "<=",
    "Same": "=",
    "NotSame": "#",
    "And": "and",
    "Or": "or",
}
OF_ANY = {
    "Max": "max",
    "Min": "min",
    "Not": "not",
    "Equal": "equal",
    "NotEqual": "notequal",
    "UnitStep": "unit_step",
    "HalfStep": "hstep",
}
CALLS = {(each.head, each.arity): each.scene for each in FUNCTIONS}
Expanded = tuple[Callable[..., Formula], list[Tree]]


def scene_text(tree: Tree) -> str:
    """Write a tree in the notation of scene files.

    Parameters
    ----------
    tree : Tree
        A tree of `holonom.expression.trees`.

    Returns
    -------
    str
        One line.

    Raises
    ------
    HolonomError
        The tree, or a part of it, is not an expression.
    """
    return converted(tree, _expanded).text


def _expanded(tree: Tree) -> Expanded:
    negative, tree = _parted(tree)
    if negative:
        return _negated, [tree]
    match tree:
        case bool():
            raise refusal(tree)
        case str():
            text = WORDS.get(tree) or quantity(tree)
        case int() | dict():
            text = _digits(tree)
        case ["Subscript", str(name), _, *_]:
            text = f"{quantity(name)}[{','.join(str(integer(index)) for index in tree[2:])}]"
        case ["Add", _, *_]:
            return _sum(tree[1:])
        case ["Subtract", a, b]:
            return _sum([a, ["Negate", b]])
        case ["Multiply", _, *_]:
            return _product(tree)
        case list() if _below(tree) is not None:
            return _product(tree)
        case ["Power", base, exponent]:
            return _power, [base, exponent]
        case ["PolyGamma", int(order), argument]:
            return (lambda formula: call(f"psi[{order}]", formula)), [argument]
        case ["Which", *clauses]:
            return _conditional, clauses
        case ["Table", int(place), time]:
            return (lambda formula: call(f"table_{place}", formula)), [time]
        case [str(head), *arguments] if head in BETWEEN:
            return (lambda *formulas: _between(BETWEEN[head], formulas)), arguments
        case [str(head), *arguments] if head in OF_ANY:
            return (lambda *formulas: call(OF_ANY[head], *formulas)), arguments
        case [str(head), *arguments] if (head, len(arguments)) in CALLS:
            return (lambda *formulas: call(CALLS[head, len(formulas)], *formulas)), arguments
        case _:
            raise refusal(tree)
    return (lambda: atom(text)), []


def _parted(tree: Tree) -> tuple[bool, Tree]:
    """Return True if a tree has a minus sign, and the tree without it."""
    match tree:
        case bool():
            return False, tree
        case int() if tree < 0:
            return True, -tree
        case {"num": str(digits), **rest} if not rest and digits.startswith("-"):
            return True, {"num": digits[1:]}
        case ["Rational", numerator, denominator]:
            negative, size = _parted(numerator)
            return negative, ["Rational", size, denominator]
        case ["Negate", part]:
            negative, size = _parted(part)
            return not negative, size
        case ["Multiply", first, *others]:
            negative, size = _parted(first)
            if not negative:
                return False, tree
            factors = others if size == 1 and others else [size, *others]
            return True, factors[0] if len(factors) == 1 else ["Multiply", *factors]
        case _:
            return False, tree


def _sum(terms: Sequence[Tree]) -> Expanded:
    signs, sizes = zip(*map(_parted, terms), strict=True)

    def build(*formulas: Formula) -> Formula:
        parts = (
            f"{' - ' if negative else ' + '}{formula.within(Rank.PRODUCT)}"
            for negative, formula in zip(signs, formulas, strict=True)
        )
        text = "".join(parts)
        return Formula(f"-{text[3:]}" if signs[0] else text[3:], Rank.SUM)

    return build, list(sizes)


def _product(tree: Tree) -> Expanded:
    over: list[Tree] = []
    under: list[Tree] = []
    for factor in tree[1:] if tree[0] == "Multiply" else [tree]:
        above, below = _fraction(factor)
        match above:
            case ["Multiply", *factors]:
                over += factors
            case _ if above != 1:
                over.append(above)
        under += [] if below == 1 else [below]

    def build(*formulas: Formula) -> Formula:
        factors = "*".join(formula.within(Rank.SIGNED) for formula in formulas[: len(over)]) or "1"
        below = formulas[len(over) :]
        if not below:
            return Formula(factors, Rank.PRODUCT)
        if len(below) == 1:
            return Formula(f"{factors}/{below[0].within(Rank.SIGNED)}", Rank.PRODUCT)
        return Formula(f"{factors}/({'*'.join(formula.within(Rank.SIGNED) for formula in below)})", Rank.PRODUCT)

    return build, over + under


def _fraction(factor: Tree) -> tuple[Tree, Tree]:
    """Return the parts of a factor above and below the stroke."""
    match factor:
        case ["Rational", numerator, denominator]:
            _digits(numerator), _digits(denominator)  # which are rejected if they are not whole numbers
            return numerator, denominator
        case ["Divide", numerator, denominator]:
            return numerator, denominator
        case _:
            below = _below(factor)
            return (factor, 1) if below is None else (1, below)


def _below(tree: Tree) -> Tree | None:
    """Return the part below a stroke, if it is all of a tree or its denominator."""
    match tree:
        case ["Rational" | "Divide", _, denominator]:
            return denominator
        case ["Power", base, exponent] if _parted(exponent)[0]:
            size = _parted(exponent)[1]
            return base if size == 1 else ["Sqrt", base] if size == ["Rational", 1, 2] else ["Power", base, size]
        case _:
            return None


def _power(base: Formula, exponent: Formula) -> Formula:
    return Formula(f"{base.within(Rank.ATOM)}^{exponent.within(Rank.ATOM)}", Rank.POWER)


def _negated(size: Formula) -> Formula:
    return Formula(f"-{size.within(Rank.PRODUCT)}", Rank.SUM)


def _between(sign: str, formulas: Sequence[Formula]) -> Formula:
    return atom(f"({f' {sign} '.join(formula.text for formula in formulas)})")


def _conditional(*clauses: Formula) -> Formula:
    cases = zip(clauses[:-2:2], clauses[1:-2:2], strict=True)
    branches = " else".join(f"if {condition.text} then {value.text}" for condition, value in cases)
    return atom(f"({branches} else {clauses[-1].text})")


def _digits(tree: Tree) -> str:
    match tree:
        case {"num": str(digits), **rest} if not rest and FLOAT.fullmatch(digits) and not INTEGER.fullmatch(digits):
            return str(Decimal(digits).normalize())
        case _:
            return str(integer(tree))
