"""MathML read as a reader does: what its letters, fractions, powers and brackets stand for, as a number.

A row becomes a list of symbols: numbers (those that fractions, roots and letters stand for among them), functions,
exponents and signs. Symbols side by side are multiplied, a function takes the one behind it, and the rows of a broken
formula are read one after the other.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from holonom.typeset.mathml import inline_mathml

FUNCTIONS = {"sin": math.sin, "cos": math.cos, "tan": math.tan, "ln": math.log}


@dataclass(frozen=True)
class Exponent:
    value: float


@dataclass(frozen=True)
class Function:
    of: Callable[[float], float]
    power: float = 1


Symbol = float | str | Exponent | Function


def letter(latex: str) -> str:
    """The letter that a name is shown as, with its dots and indices."""
    return _text(ElementTree.fromstring(inline_mathml(latex)))


def sides(latex: str, values: Mapping[str, float]) -> tuple[float, float]:
    """Values of the sides of an equation, from those of its letters."""
    read = _symbols(ElementTree.fromstring(inline_mathml(latex)), values)
    equals = read.index("=")
    return _sum_of(read[:equals]), _sum_of(read[equals + 1 :])


# ---- elements to symbols ---------------------------------------------------------------------------


def _symbols(element: Element, values: Mapping[str, float]) -> list[Symbol]:
    kind, parts = element.tag.rpartition("}")[2], list(element)
    if kind in ("mfrac", "msqrt"):
        return [_value(kind, parts, values)]
    if kind in ("msup", "msubsup"):
        return _raised(parts, values)
    if kind in ("msub", "mover", "mi", "mtext"):
        return _named(_text(element), values)
    if kind == "mn":
        return [float(element.text)]
    if kind == "mo":
        return [element.text]
    return [symbol for part in parts for symbol in _symbols(part, values)]


def _value(kind: str, parts: list[Element], values: Mapping[str, float]) -> float:
    if kind == "mfrac":
        above, below = (_sum_of(_symbols(part, values)) for part in parts)
        return above / below
    return math.sqrt(_sum_of([symbol for part in parts for symbol in _symbols(part, values)]))


def _raised(parts: list[Element], values: Mapping[str, float]) -> list[Symbol]:
    *base, exponent = parts
    power = _sum_of(_symbols(exponent, values))
    name = "".join(map(_text, base))
    if name in FUNCTIONS:
        return [Function(FUNCTIONS[name], power)]
    if name == "e" and "e" not in values:
        return [math.exp(power)]
    read = _named(name, values) if len(base) == 2 else _symbols(base[0], values)
    return [*read, Exponent(power)]


def _named(name: str, values: Mapping[str, float]) -> list[Symbol]:
    if not name:
        return []
    return [Function(FUNCTIONS[name])] if name in FUNCTIONS else [values[name]]


def _text(element: Element) -> str:
    return "".join(element.itertext())


# ---- symbols to a value ------------------------------------------------------------------------------


def _sum_of(symbols: list[Symbol]) -> float:
    rest = list(reversed(symbols))
    total = _sum(rest)
    assert not rest, f"nothing may be left over: {symbols}"
    return total


def _sum(rest: list[Symbol]) -> float:
    total = 0.0
    sign = -1 if rest[-1] == "−" else 1
    if rest[-1] in ("+", "−"):
        rest.pop()
    while True:
        total += sign * _product(rest)
        if not rest or rest[-1] not in ("+", "−"):
            return total
        sign = 1 if rest.pop() == "+" else -1


def _product(rest: list[Symbol]) -> float:
    product = _factor(rest)
    while rest and rest[-1] not in ("+", "−", ")"):
        if rest[-1] in ("·", "×"):
            rest.pop()
        product *= _factor(rest)
    return product


def _factor(rest: list[Symbol]) -> float:
    symbol = rest.pop()
    if isinstance(symbol, Function):
        return symbol.of(_factor(rest)) ** symbol.power
    if symbol == "(":
        symbol = _sum(rest)
        assert rest.pop() == ")"
    assert isinstance(symbol, float), symbol
    return symbol ** rest.pop().value if rest and isinstance(rest[-1], Exponent) else symbol
