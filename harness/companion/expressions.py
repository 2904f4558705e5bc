"""SymPy expressions that the exercises ask about."""

from collections.abc import Mapping

import sympy
from sympy import Expr, Symbol, simplify

from ..mathjson import Tree, to_sympy
from ..record import Equation, Scene

RATES = ("{}".format, "dot({})".format, "ddot({})".format)  # names of a quantity and its time derivatives


def under(law: Mapping[str, Expr], expression: Expr) -> Expr:
    """Return an expression under a control law, simplified.

    Parameters
    ----------
    law : mapping of str to Expr
        Control law by control.
    expression : Expr
        SymPy expression.

    Returns
    -------
    Expr
        Simplified expression.
    """
    time = Symbol("t", real=True)
    for control, value in law.items():
        for order, name in enumerate((control, f"dot({control})", f"ddot({control})")):
            expression = expression.subs(Symbol(name, real=True), value.diff(time, order))
    return sympy.factor(simplify(expression))


def at(expression: Expr, values: Mapping[str, Expr]) -> Expr:
    """Return an expression with values in place of names.

    Parameters
    ----------
    expression : Expr
        SymPy expression.
    values : mapping of str to Expr
        Values by name.

    Returns
    -------
    Expr
        Expression with the values.
    """
    return expression.subs({Symbol(name, real=True): value for name, value in values.items()})


def at_start(scene: Scene, equation: Equation) -> dict[str, Expr]:
    """Return the right sides of an equation at the initial state of a scene.

    Parameters
    ----------
    scene : Scene
        Scene of a record, whose initial time is zero.
    equation : Equation
        Equation in the symbols of the initial state or of the state.

    Returns
    -------
    dict of str to Expr
        Values by the left sides.
    """
    begun = {f"{name}_0": value for name, value in scene.initial_state.items()}
    known = {**scene.parameter_values, **scene.initial_state, **begun, "t": 0}
    return {str(each.left): at(under(scene.control_law, each.right), known) for each in equation.relations}


def common_denominator(equations: Mapping[str, Equation]) -> Expr:
    """Return the denominator of the accelerations (11).

    Parameters
    ----------
    equations : mapping of str to Equation
        Equations by id.

    Returns
    -------
    Expr
        Common denominator.
    """
    return sympy.fraction(sympy.together(equations["accelerations"].relations[0].right))[1]


def right_side(tree: Tree) -> Expr:
    """Return the right side of a printed equation of the example, for SymPy.

    Parameters
    ----------
    tree : Tree
        Printed equation as MathJSON.

    Returns
    -------
    Expr
        Right side.
    """
    return to_sympy(_named(tree[2]))


def _named(tree: Tree) -> Tree:
    """Return the tree with the names of a record, such as dot(q1) for Dot of q1."""
    match tree:
        case [("Dot" | "Ddot") as dots, str(name)]:
            return f"{dots.lower()}({name})"
        case [head, *arguments]:
            return [head, *map(_named, arguments)]
        case _:
            return tree


def zeros(expression: Expr) -> list[Expr]:
    """Return the zeros, complex ones too, of an expression in a single symbol.

    Parameters
    ----------
    expression : Expr
        SymPy expression.

    Returns
    -------
    list of Expr
        Zeros.
    """
    (symbol,) = expression.free_symbols
    return sympy.solve(expression.subs(symbol, sympy.Dummy()))


def in_sum(expression: Expr) -> Expr:
    """Return an expression of the example in terms of S = q1 + q2.

    Parameters
    ----------
    expression : Expr
        SymPy expression.

    Returns
    -------
    Expr
        Expression in S.
    """
    replaced = {
        Symbol(name("q2"), real=True): Symbol(name("S"), real=True) - Symbol(name("q1"), real=True) for name in RATES
    }
    found = simplify(expression.subs(replaced))
    return sympy.collect(
        sympy.expand(sympy.numer(found)), [Symbol(name("S"), real=True) for name in RATES]
    ) / sympy.factor(sympy.denom(found))


def sum_acceleration(equations: Mapping[str, Equation]) -> Expr:
    """Return the acceleration of S = q1 + q2 with its multiplier, in terms of S.

    Parameters
    ----------
    equations : mapping of str to Equation
        Equations of the example by id.

    Returns
    -------
    Expr
        Acceleration.
    """
    first, second = (relation.right for relation in equations["driven_accelerations"].relations[:2])
    return sympy.collect(in_sum(sympy.expand(first + second)), Symbol("lambda1", real=True))
