"""Motion programs for the tests: documents written by hand, random ones, and a chain of any length."""

import json
import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import assume
from hypothesis import strategies as st
from reference import IllConditioned, reference

from holonom.program.heyoka_function import heyoka_expressions, import_heyoka
from holonom.program.motion_program import Program, read_program

Tree = Any

POINTS = 11  # one block of eight lanes in C, and three points more

HALF = ["Rational", 1, 2]

# Arguments that keep a function away from the borders of its domain, and its values of the order of one.
BOUNDED = {
    **dict.fromkeys(("Sin", "Cos", "Tanh", "Arctan", "Arsinh", "Erf", "Negate"), lambda x: x),
    **dict.fromkeys(("Exp", "Tan", "Sinh", "Cosh"), lambda x: ["Sin", x]),
    **dict.fromkeys(("Arcsin", "Arccos", "Artanh"), lambda x: ["Multiply", HALF, ["Sin", x]]),
    **dict.fromkeys(("Sqrt", "Ln"), lambda x: ["Add", 1, ["Power", x, 2]]),
    **dict.fromkeys(("Abs", "Sign"), lambda x: ["Subtract", x, {"num": "1.0000000000000001e0"}]),
    "Arcosh": lambda x: ["Add", 2, ["Power", x, 2]],
}
EXPONENTS = [2, 3, 5, -1, -2, HALF, ["Rational", -1, 2], ["Rational", 3, 2], "Pi", "ExponentialE"]


def document(
    inputs: Sequence[str], assignments: Sequence[tuple[str, Tree]], outputs: Mapping[str, Tree]
) -> dict[str, Any]:
    """A program's document, as Maxima would write it."""
    return {
        "format": "holonom-program",
        "version": 2,
        "scene": None,
        "solve": "direct",
        "method": "bordered",
        "redundant": [],
        "operations": 0,
        "inputs": list(inputs),
        "assignments": [list(assignment) for assignment in assignments],
        "outputs": dict(outputs),
    }


def program(inputs: Sequence[str], assignments: Sequence[tuple[str, Tree]], outputs: Mapping[str, Tree]) -> Program:
    """A program, read from its document."""
    return read_program(json.dumps(document(inputs, assignments, outputs)))


PENDULUM = program(
    ["t", "x", "y", "dot(x)", "dot(y)", "g"],
    [
        ("w1", ["Add", ["Power", "x", 2], ["Power", "y", 2]]),
        ("w2", ["Add", ["Power", "dot(x)", 2], ["Power", "dot(y)", 2]]),
        ("w3", ["Divide", ["Subtract", ["Multiply", "g", "y"], "w2"], "w1"]),
        ("w4", ["Multiply", "w3", "x"]),
        ("w5", ["Subtract", ["Multiply", "w3", "y"], "g"]),
    ],
    {"ddot(x)": "w4", "ddot(y)": "w5", "lambda1": "w3"},
)
"""A unit mass on a rod, f = (x^2 + y^2 - l^2)/2: ddot(r) = -g e_y + lambda r."""


@st.composite
def random_programs(draw: st.DrawFn) -> Program:
    """Programs with every operation, whose values stay moderate for moderate inputs."""
    known, assignments = ["a", "b", "dot(c)"], []
    for index in range(draw(st.integers(1, 6))):
        assignments.append((f"w{index}", draw(_expressions(known))))
        known.append(f"w{index}")
    chosen = draw(st.lists(st.sampled_from(known), min_size=1, max_size=3))
    outputs = {f"out{index}": name for index, name in enumerate([*chosen, known[-1]])}
    return program(known[:3], assignments, outputs | {"constant": ["Rational", -1, 3]})


def _expressions(known: Sequence[str]) -> st.SearchStrategy[Tree]:
    rationals = st.tuples(st.integers(-99, 99), st.integers(1, 99)).map(lambda pq: ["Rational", *pq])
    numbers = st.integers(-3, 3) | rationals | st.sampled_from(["Pi", {"num": "-25e-2"}, {"num": "1.1e0"}])
    return st.recursive(st.sampled_from(known) | numbers, _applications, max_leaves=8)


def _applications(parts: st.SearchStrategy[Tree]) -> st.SearchStrategy[Tree]:
    def positive(x: Tree) -> Tree:
        return ["Add", HALF, ["Power", x, 2]]

    return st.one_of(
        st.builds(
            lambda head, terms: [head, *terms], st.sampled_from(["Add", "Multiply"]), st.lists(parts, min_size=1)
        ),
        st.builds(lambda a, b: ["Subtract", a, b], parts, parts),
        st.builds(lambda a, b: ["Divide", a, positive(b)], parts, parts),
        st.builds(lambda a, b: ["Arctan2", a, positive(b)], parts, parts),
        st.builds(lambda a, exponent: ["Power", positive(a), exponent], parts, st.sampled_from(EXPONENTS)),
        st.builds(lambda head, x: [head, BOUNDED[head](x)], st.sampled_from(sorted(BOUNDED)), parts),
    )


def chain(links: int) -> Program:
    """A planar chain of unit masses on unit links, the first of length u, by hand: G lambda = b is tridiagonal."""
    every = range(1, links + 1)
    inputs = [
        "t",
        *(f"{axis}{k}" for k in every for axis in "xy"),
        *(f"dot({axis}{k})" for k in every for axis in "xy"),
        *("u", "dot(u)", "ddot(u)", "g"),
    ]
    assignments, outputs = [], {}

    def let(name: str, *tree: Tree) -> None:
        assignments.append((name, list(tree)))

    for k in every:
        for axis in "xy":
            let(f"d{axis}{k}", *(("Subtract", f"{axis}{k}", f"{axis}{k - 1}") if k > 1 else ("Add", f"{axis}{k}")))
            rate = ("Subtract", f"dot({axis}{k})", f"dot({axis}{k - 1})") if k > 1 else ("Add", f"dot({axis}{k})")
            let(f"e{axis}{k}", *rate)
        let(f"c{k}", "Add", ["Power", f"ex{k}", 2], ["Power", f"ey{k}", 2])
        let(f"G{k}", "Add", ["Power", f"dx{k}", 2], ["Power", f"dy{k}", 2])
        if k == 1:
            moved = ["Add", ["Multiply", "g", "y1"], ["Power", "dot(u)", 2], ["Multiply", "u", "ddot(u)"]]
            let("b1", "Subtract", moved, "c1")
            let("D1", "Add", "G1")
        else:
            let(f"s{k}", "Add", *(["Multiply", f"d{axis}{k}", f"d{axis}{k - 1}"] for axis in "xy"))
            let(f"l{k}", "Divide", f"s{k}", f"D{k - 1}")
            let(f"D{k}", "Subtract", ["Multiply", 2, f"G{k}"], ["Multiply", f"l{k}", f"s{k}"])
            let(f"b{k}", "Subtract", ["Multiply", f"l{k}", f"b{k - 1}"], f"c{k}")
    for k in reversed(every):
        last = ("Divide", f"b{k}", f"D{k}")
        let(f"m{k}", *last if k == links else ("Add", list(last), ["Multiply", f"l{k + 1}", f"m{k + 1}"]))
        outputs[f"lambda{k}"] = f"m{k}"
    for k in every:
        for axis in "xy":
            terms = [["Multiply", f"d{axis}{k}", f"m{k}"]]
            terms += [["Negate", ["Multiply", f"d{axis}{k + 1}", f"m{k + 1}"]]] if k < links else []
            terms += [["Negate", "g"]] if axis == "y" else []
            let(f"a{axis}{k}", "Add", *terms)
            outputs[f"ddot({axis}{k})"] = f"a{axis}{k}"
    return program(inputs, assignments, outputs)


ENDS = replace(program(["t", "a"], [("w", ["Multiply", "t", "a"])], {"out": "w"}), law_span=("-2", "0"))
_INSIDE, _OUTSIDE = [-1.0, 0.0, -2.0, np.nextafter(-2.0, -3.0), 1e-17], [0.1, 100.0, -2.1]
ENDS_POINTS = np.array([[*_INSIDE, *_OUTSIDE], [2.0] * 8])
ENDS_VALUES = [*(pytest.approx(2 * t) for t in _INSIDE), *[pytest.approx(np.nan, nan_ok=True)] * 3]
"""A program whose functions of the time have a span, at points inside, with rounding, and outside, and its values."""


def random_points(written, seed=0):
    """Columns of an array, one a point, with coordinates of the order of one."""
    draw = random.Random(seed)
    return np.array([[draw.uniform(-2, 2) for _ in range(POINTS)] for _ in written.inputs])


def assume_well_conditioned(written: Program) -> None:
    """Have Hypothesis draw another program where rounding errors of one's values have no bound at the random points."""
    try:
        for point in random_points(written).T:
            reference(written, point.tolist())
    except IllConditioned:
        assume(False)


def heyoka_function(written: Program, *, compact: bool = False) -> Callable[[np.ndarray], np.ndarray]:
    """The program compiled by heyoka."""
    variables = {name: import_heyoka().expression(name) for name in written.inputs}
    results = heyoka_expressions(written, variables)
    function = import_heyoka().cfunc(list(results.values()), vars=list(variables.values()), compact_mode=compact)
    return lambda points: function(np.ascontiguousarray(points, dtype=float))
