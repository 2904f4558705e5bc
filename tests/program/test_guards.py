"""Programs of functions that conditions guard: each branch has a value where another one holds."""

import math
import random
import re

import numpy as np
import pytest

import holonom

PLACES = ["x", "-x", "(x - 1/2)", "(v - x)", "(1/3 - v)"]
FACTORS = ["(1 - v/5)", "v", "(2 + sin(x))", "x^2", "3"]
GUARDED = [
    "max(0, {a})^({p})",
    "(if {a} > 0 then sqrt({a}) else 0)",
    "(if {a} > 1/4 then log({a}) else -1)",
    "(if abs({a}) < 1 then sqrt(1 - {a}^2) else 0)",
    "asin(max(-1, min(1, {a})))",
    "(if {a} > 1/5 then 1/{a} else 5)",
    "log(1 + max(0, {a}))",
    "(if {a} < 0 then exp(2000*{a}) else 1)",
]
NESTED = [
    "max(0, {g}*{f})",
    "max(-1, min(1, {g}*{f}))",
    "abs({g} - {f})",
    "(if {g} > {f} then {g} else {f})",
    "min({g}*{f}, {h})",
    "max(0, {f}*max(0, {g}*{f}))",
]


def in_python(template: str) -> str:
    """A template with Python's own branches."""
    return re.sub(r"^\(if (.*) then (.*) else (.*)\)$", r"(\2 if \1 else \3)", template.replace("^", "**"))


def drawn(chance: random.Random) -> tuple[str, str]:
    """A function of x and v, finite everywhere, with functions inside that are not: for Maxima, and for Python."""
    outer, factor, *inner = chance.choice(NESTED), chance.choice(FACTORS), *chance.choices(GUARDED, k=2)
    places, powers = chance.choices(PLACES, k=2), chance.choices(["3/2", "1/2", "5/2"], k=2)
    written = []
    for form in (str, in_python):
        g, h = (form(each).format(a=a, p=p) for each, a, p in zip(inner, places, powers, strict=True))
        written.append(form(outer).format(g=g, h=h, f=form(factor)))
    return written[0], written[1]


@pytest.mark.parametrize("seed", range(16))
def test_a_branch_that_does_not_hold_has_a_finite_value(seed):
    chance = random.Random(seed)
    expression, by_python = drawn(chance)
    force = expression.replace("v", "dot(x)")
    scene = holonom.system(f"""
      system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [{force}])$
      run : holonomic_scene(system, initial_state = [x = 1/7, dot(x) = 1/9], time_span = [0, 1])$""")
    evaluate = scene.program().lambdify()
    for _ in range(20):
        x, v = chance.gauss(0, 1), chance.gauss(0, 1)
        assert np.ravel(evaluate([0.5, x, v]))[0] == pytest.approx(
            eval(by_python, {**vars(math), "x": x, "v": v}), abs=1e-11
        )
