"""Whether two records say different things, found without any code of the package: trees are evaluated at points."""

import random
from fractions import Fraction

import mpmath
from mpmath import mp

TREES = ("left", "right", "value", "constraints", "control_law", "parameter_values", "initial_state", "time_span")
"""Members of a record that hold expressions."""

POINTS = 60
"""Points at which two expressions are compared; one at which they differ is enough."""

DIGITS = 120
"""Digits in which they are, and those in which they must differ, relative to their size."""
DIFFERING = 90

CONSTANTS = {"Pi": lambda: +mp.pi, "ExponentialE": lambda: +mp.e, "EulerGamma": lambda: +mp.euler}
FUNCTIONS = {
    "Exp": mp.exp,
    "Ln": mp.log,
    "Abs": abs,
    "Sign": mp.sign,
    "Sin": mp.sin,
    "Cos": mp.cos,
    "Tan": mp.tan,
    "Sinh": mp.sinh,
    "Cosh": mp.cosh,
    "Tanh": mp.tanh,
    **{name.capitalize(): getattr(mp, name) for name in ("sec", "csc", "cot", "sech", "csch", "coth", "erf", "erfc")},
    "Arctan": mp.atan,
    "Arcsin": mp.asin,
    "Arccos": mp.acos,
    "Sqrt": mp.sqrt,
    "Negate": lambda x: -x,
}


def difference(true, false, path=""):
    """Tell the first place where two records say different things; empty where there is none."""
    if path.rpartition(".")[2] in TREES and not (isinstance(true, dict) and "num" not in true):
        return _difference_of_trees(true, false, path)
    if type(true) is not type(false):
        return f"{path}: {true!r:.60} is {false!r:.60}"
    if isinstance(true, dict):
        if list(true) != list(false):
            return f"{path}: other members"
        parts = [(true[key], false[key], f"{path}.{_inner(path, key)}") for key in true]
    elif isinstance(true, list):
        if len(true) != len(false):
            return f"{path}: {len(true)} items are {len(false)}"
        parts = [(a, b, f"{path}[{i}]") for i, (a, b) in enumerate(zip(true, false, strict=True))]
    else:
        return "" if true == false else f"{path}: {true!r} is {false!r}"
    return next((found for part in parts if (found := difference(*part))), "")


def _inner(path, key):
    """The values of a control law are trees as well."""
    return "value" if path.rpartition(".")[2] in TREES else key


def _difference_of_trees(true, false, path):
    if isinstance(true, list) and (not true or not isinstance(true[0], str)):  # several trees
        if not isinstance(false, list) or len(true) != len(false):
            return f"{path}: {true!r:.60} is {false!r:.60}"
        pairs = zip(true, false, strict=True)
        return next((found for a, b in pairs if (found := _difference_of_trees(a, b, path))), "")
    if true is None or false is None:
        return "" if true is false else f"{path}: nothing is something"
    if true != false and (differing := _point_of_difference(true, false)):
        return f"{path} at {differing}"
    return ""


def _point_of_difference(true, false):
    names = sorted(_names(true) | _names(false))
    for attempt in range(POINTS):
        point = _point(names, attempt)
        with mp.workdps(DIGITS):
            a, b = _value(true, point), _value(false, point)
            if a is None or mp.im(a):
                continue
            if b is None or abs(a - b) > mp.mpf(10) ** -DIFFERING * max(abs(a), abs(b)):
                return {name: float(value) for name, value in point.items()} or "the only value"
    return None


def _point(names, attempt):
    """Numbers of several sizes, every third time positive, in the second half near small integers as well."""
    draw = random.Random(f"evaluator {attempt}")
    span = (0.1, 3, 40, 10**6)[attempt % 4]
    lowest = -span if attempt % 3 else 0
    shifts = (0, 1, 3) if attempt > POINTS / 2 else (0,)
    return {name: Fraction(draw.uniform(lowest, span)) + draw.choice(shifts) for name in names}


def _names(tree):
    if isinstance(tree, str):
        return set() if tree in CONSTANTS else {tree}
    if isinstance(tree, list):
        return {str(tree)} if tree[0] == "Subscript" else set().union(*map(_names, tree[1:]))
    return set()


def _value(tree, point):
    """The number that a tree is at a point; None where it is none."""
    try:
        value = _number(tree, point)
        return value if mp.isfinite(value) else None
    except (ZeroDivisionError, OverflowError, ValueError):
        return None


def _number(tree, point):
    match tree:
        case int():
            return mp.mpf(tree)
        case {"num": digits}:
            return _fraction(Fraction(digits))
        case str():
            return CONSTANTS[tree]() if tree in CONSTANTS else _fraction(point[tree])
        case ["Subscript", *_]:
            return _fraction(point[str(tree)])
        case ["Rational", a, b]:
            return _number(a, point) / _number(b, point)
        case ["Add", *parts]:
            return mp.fsum(_number(part, point) for part in parts)
        case ["Multiply", *parts]:
            return mp.fprod(_number(part, point) for part in parts)
        case ["Power", base, exponent]:
            power = _number(exponent, point)
            return _number(base, point) ** (int(power) if mp.isint(power) else power)
        case ["Divide", a, b]:
            return _number(a, point) / _number(b, point)
        case ["Subtract", a, b]:
            return _number(a, point) - _number(b, point)
        case [head, part]:
            return FUNCTIONS[head](_number(part, point))
    raise ValueError(tree)


def _fraction(value):
    return mpmath.mpf(value.numerator) / value.denominator
