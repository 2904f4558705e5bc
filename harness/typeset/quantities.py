"""Typeset names of quantities with dots and indices.

``dot(q1)_0`` is q with a dot and the indices 1 and 0. `spelled_apart` spells names that would look the same, as ``a1``
and ``a_1``.
"""

import re
import unicodedata
from collections import defaultdict
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache

from sympy.core.alphabets import greeks
from sympy.printing.latex import tex_greek_dictionary

from ..expression.functions import CONSTANTS
from .boxes import COMMA, SEMICOLON, Box, above, below, beside, bracketed, digits, dotted, separated, word

RATE = re.compile(r"(d{1,3})ot\((.+)\)(\w*)")
UNDERSCORE = r"\_"  # of a name that is nothing else
NUMBERED = re.compile(r"([^\W\d]+?)(\d*)")
OPEN = {"phi": r"\varphi", "th": r"\theta"}  # the shape that mechanics writes, and its shorthand
RESERVED = frozenset(CONSTANTS[name].latex for name in ("Pi", "ExponentialE"))  # what no quantity is to look like
SPELLED: ContextVar[frozenset[str]] = ContextVar("spelled", default=frozenset())
GREEK = {name.replace("lamda", "lambda") for name in greeks}


@contextmanager
def spelled_apart(names: Iterable[str]) -> Iterator[None]:
    """Spell out names that would look like others, or like a constant.

    Initial values ``x_0`` keep their index if the name of x is not spelled out.

    Parameters
    ----------
    names : iterable of str
        All names of a document.

    Yields
    ------
    None
        While the names are spelled out.
    """
    alike: dict[str, set[str]] = defaultdict(set)
    own = set(names)
    for name in own:
        alike[name_box(name).latex].add(name)
    apart = {name for latex, same in alike.items() if len(same) > 1 or latex in RESERVED for name in same}
    initials = {f"{name}_0" for name in own - apart}
    token = SPELLED.set(frozenset(apart - initials))
    try:
        yield
    finally:
        SPELLED.reset(token)


def name_box(name: str, dots: int = 0) -> Box:
    """Return a quantity under its dots, with the indices in its name.

    Parameters
    ----------
    name : str
        Name in a derivation record, such as ``dot(q1)_0``.
    dots : int
        Number of dots besides those in the name.

    Returns
    -------
    Box
    """
    return _name_box(name, dots, SPELLED.get())


@cache
def _name_box(name: str, dots: int, spelled: frozenset[str]) -> Box:
    return _indexed_box(name, [], dots, spelled)


def indexed_box(name: str, indices: list[Box], dots: int = 0) -> Box:
    """Return a quantity with further indices before those in its name.

    ``q_0[s]`` has the indices s and 0.

    Parameters
    ----------
    name : str
        Name in a derivation record.
    indices : list of Box
        Further indices.
    dots : int
        Number of dots besides those in the name.

    Returns
    -------
    Box
    """
    return _indexed_box(name, indices, dots, SPELLED.get())


def _indexed_box(name: str, indices: list[Box], dots: int, spelled: frozenset[str]) -> Box:
    if name in spelled:
        return _with_indices(dotted(_spelled(name), dots), indices)
    if name == "A_inverse" and indices:
        return above(symbol_box("A"), beside(*indices))
    if name == "christoffel" and len(indices) == 3:
        return _christoffel(*indices)
    if name == "delta" and len(indices) == 2:
        return below(above(symbol_box("delta"), indices[0]), indices[1])
    if rate := RATE.fullmatch(name):
        return _indexed_box(rate[2] + rate[3], indices, dots + len(rate[1]), spelled)
    stem, *parts = [part for part in name.replace("%", "").split("_") if part] or [UNDERSCORE]
    letter, number = _symbol_and_number(stem)
    own = [digits(number)] if number else []
    together = [beside(*indices)] if indices else []
    return _with_indices(dotted(symbol_box(letter), dots), [*together, *own, *map(_index, parts)])


def _symbol_and_number(stem: str) -> tuple[str, str]:
    found = NUMBERED.fullmatch(stem)
    return (found[1], found[2]) if found else (stem, "")


def symbol_box(letter: str) -> Box:
    """Return a box of a Latin or Greek letter, or of a word.

    Parameters
    ----------
    letter : str
        A letter, the name of a Greek letter, or a word.

    Returns
    -------
    Box
    """
    letter = spelled_out(letter)
    if letter.lower() in GREEK or letter in OPEN:
        return word(OPEN.get(letter) or tex_greek_dictionary.get(letter, rf"\{letter}"), 1)
    if len(letter) == 1 and letter.isascii():
        return word(letter, 1)
    return word(rf"\text{{{letter}}}", len(letter))


def spelled_out(letter: str) -> str:
    """Return the name of a Greek letter, or the text unchanged.

    Parameters
    ----------
    letter : str
        A letter or any text.

    Returns
    -------
    str
        Name in LaTeX's spelling, such as ``lambda``.
    """
    match unicodedata.name(letter, "").split() if len(letter) == 1 else []:
        case ["GREEK", "SMALL", "LETTER", name]:
            return name.lower().replace("lamda", "lambda")
        case ["GREEK", "CAPITAL", "LETTER", name]:
            return name.capitalize().replace("Lamda", "Lambda")
        case _:
            return letter


def _spelled(name: str) -> Box:
    parts = UNDERSCORE.join(rf"\text{{{part}}}" if part else "" for part in name.replace("%", "").split("_"))
    return word(f"{{{parts}}}", len(name))


def _index(part: str) -> Box:
    if part.isdecimal():
        return digits(part)
    return name_box(part) if len(part) == 1 or part.lower() in GREEK else word(rf"\text{{{part}}}", len(part))


def _christoffel(first: Box, second: Box, third: Box) -> Box:
    """Return the Christoffel symbol of the first kind, km over s."""
    return bracketed(beside(first, COMMA, second, SEMICOLON, third), "[", "]")


def _with_indices(letter: Box, indices: list[Box]) -> Box:
    return below(letter, separated(indices, COMMA)) if indices else letter
