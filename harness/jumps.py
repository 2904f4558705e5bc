"""Signs that jump at given values of the quantities that they depend on."""

from collections.abc import Iterable, Mapping

import sympy as sp


def jumping_at(values: Mapping[str, sp.Expr], expressions: Iterable[sp.Expr]) -> tuple[sp.Expr, ...]:
    """Return the functions whose signs jump at given values and change expressions.

    They vanish there. All such signs in an expression that has no value there are taken to change it.

    Parameters
    ----------
    values : mapping of str to Expr
        Exact values of quantities, by their names.
    expressions : iterable of Expr
        Expressions with signs and absolute values.

    Returns
    -------
    tuple of Expr

    Examples
    --------
    The force of dry friction jumps where the velocity vanishes. That of a drag by its square does not:

    >>> v = sp.Symbol("v", real=True)
    >>> jumping_at({"v": sp.Integer(0)}, [sp.sign(v)])
    (v,)
    >>> jumping_at({"v": sp.Integer(0)}, [v * abs(v)])
    ()
    """
    known = {sp.Symbol(name, real=True): value for name, value in values.items()}
    signs: dict[sp.Expr, sp.Symbol] = {}

    def vanishes(part: sp.Expr) -> bool:
        return isinstance(part, sp.sign | sp.Abs) and bool(part.args[0].xreplace(known).equals(0))

    def by_name(part: sp.Expr) -> sp.Expr:
        sign = signs.setdefault(part.args[0], sp.Dummy(real=True))
        return sign if isinstance(part, sp.sign) else sign * part.args[0]

    def deciding(expression: sp.Expr) -> set[sp.Symbol]:
        named = expression.replace(vanishes, by_name)
        at_values = named.xreplace(known).expand()
        return named.free_symbols if at_values.has(sp.nan, sp.zoo) else at_values.free_symbols

    remaining = set().union(*map(deciding, expressions))
    return tuple(function for function, sign in signs.items() if sign in remaining)
