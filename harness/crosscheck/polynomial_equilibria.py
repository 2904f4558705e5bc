"""Number of solutions of polynomial equations, and exact values as text.

Let l be a linear form whose values in all complex solutions differ, as one with random coefficients does. Then a
solution is real if and only if its value of l is. These values are the roots of the only polynomial in l alone in a
lexicographic Groebner basis (Rouillier, Solving zero-dimensional systems through the rational univariate
representation, Appl. Algebra Eng. Commun. Comput. 9 (1999) 433), whose real ones Sturm's theorem counts.
"""

from __future__ import annotations

import ast
import operator
import random
from collections.abc import Mapping, Sequence

import sympy as sp
from sympy.polys.polyerrors import PolynomialError

FORMS, COEFFICIENTS = 2, 10**4  # forms that have to agree; their coefficients at most
OPERATIONS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.USub: operator.neg,
}
FUNCTIONS = {"sqrt": sp.sqrt, "acos": sp.acos}
LARGEST_POWER = 100  # in an exact value: 9**9**9 takes all time and memory
ROOT = sp.Symbol("x")


def count_real_solutions(equations: Sequence[sp.Expr], unknowns: Sequence[sp.Symbol]) -> int | None:
    """Count the distinct real solutions, up to whole turns of angles.

    Parameters
    ----------
    equations : sequence of Expr
        They vanish. An unknown with a sine or cosine must occur in no other way.
    unknowns : sequence of Symbol

    Returns
    -------
    int or None
        None if the equations are not polynomial, or have infinitely many complex solutions.
    """
    angles = [q for q in unknowns if any(each.has(sp.sin(q), sp.cos(q)) for each in map(_expanded, equations))]
    sides = {f(q): sp.Symbol(f"{f.__name__}({q})", real=True) for q in angles for f in (sp.cos, sp.sin)}
    polynomials = [_expanded(each).xreplace(sides) for each in equations]
    polynomials += [sides[sp.cos(q)] ** 2 + sides[sp.sin(q)] ** 2 - 1 for q in angles]
    names = [*(q for q in unknowns if q not in angles), *sides.values()]
    draw, found = random.Random(1), set()
    for _ in range(FORMS):
        form = sp.Dummy("form")
        total = sp.Add(*(draw.randint(-COEFFICIENTS, COEFFICIENTS) * name for name in names))
        try:
            basis = sp.groebner([*filter(None, polynomials), form - total], *names, form, order="grevlex", domain="QQ")
        except (PolynomialError, sp.CoercionFailed):
            return None
        if basis.exprs == [1]:
            return 0
        if not basis.is_zero_dimensional:
            return None
        values = sp.Poly(basis.fglm("lex").exprs[-1], form).sqf_part()
        found.add((values.degree(), values.count_roots()))
    return max(found)[1]


def _expanded(expression: sp.Expr) -> sp.Expr:
    return sp.expand(sp.expand_trig(expression))


def read_exact(text: str) -> sp.Expr | None:
    """Return an exact value of a document: a number of roots and arc cosines.

    Parameters
    ----------
    text : str

    Returns
    -------
    Expr or None
        None if it is written in another way.
    """
    try:
        return _read(ast.parse(text, mode="eval").body, {"pi": sp.pi})
    except (SyntaxError, KeyError, TypeError, ValueError, IndexError, sp.PolynomialError):
        return None


def _read(part: ast.expr, names: Mapping[str, sp.Expr]) -> sp.Expr:
    match part:
        case ast.Constant(value=int(number)):
            return sp.Integer(number)
        case ast.Name(id=name):
            return names[name]
        case ast.BinOp(left, operation, right):
            sides = _read(left, names), _read(right, names)
            if isinstance(operation, ast.Pow) and not abs(sides[1]) <= LARGEST_POWER:
                raise ValueError(part)
            return OPERATIONS[type(operation)](*sides)
        case ast.UnaryOp(operation, operand):
            return OPERATIONS[type(operation)](_read(operand, names))
        case ast.Call(func=ast.Name(id="CRootOf"), args=[polynomial, index]):
            return sp.CRootOf(_read(polynomial, {"x": ROOT}), int(_read(index, {})))
        case ast.Call(func=ast.Name(id=name), args=[argument]):
            return FUNCTIONS[name](_read(argument, names))
    raise ValueError(ast.dump(part))
