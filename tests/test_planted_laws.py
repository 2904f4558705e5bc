"""Laws that are known to make motions free, hidden by a random change of coordinates and controls.

A system whose laws are known is written in other coordinates and other controls: shears, linear and quadratic, that
move with the time, and factors that depend on it. The changes are invertible, so the law is still there: the answer may
be that nothing was decided, but never that there is none, that the motion is not free, or that these are all when the
planted one is missing, for each of some values of a parameter that is left open. Where the system is known to have no
law, none may be shown.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from scipy.optimize import least_squares

from holonom.crosscheck.report import Verdict
from holonom.free_motion import FreeMotionVerdict, UniversalLaw, free_motion
from holonom.sandbox import Limits

t = sp.Symbol("t", real=True)
Change = Mapping[sp.Symbol, sp.Expr]


@dataclass(frozen=True)
class Base:
    """A system of unit masses in Cartesian coordinates, with a law that makes motions free, or with none.

    Under ``law`` the scene moves; ``universal`` says whether it makes every motion free, or no law does. ``values`` are
    those of the parameters, which the scene leaves open, for which the law does.
    """

    coordinates: tuple[sp.Symbol, ...]
    controls: tuple[sp.Symbol, ...]
    forces: tuple[sp.Expr, ...]
    constraints: tuple[sp.Expr, ...]
    law: Change
    state: Mapping[sp.Symbol, tuple[sp.Expr, sp.Expr]]
    universal: bool = True
    values: Sequence[Mapping[sp.Symbol, float]] = ({},)
    span: str = ""
    times: np.ndarray = field(default_factory=lambda: np.linspace(-0.6, 0.7, 11))

    @property
    def parameters(self) -> Sequence[sp.Symbol]:
        return list(self.values[0])


def real(names: str) -> tuple[sp.Symbol, ...]:
    return sp.symbols(names, real=True, seq=True)


def speed(x: sp.Symbol) -> sp.Symbol:
    return sp.Symbol(f"dot({x.name})", real=True)


a, b, c = real("a b c")
u, w, p = real("u w p")
half, third = sp.Rational(1, 2), sp.Rational(1, 3)
BOTH_SIGNS = ({p: 1.3}, {p: -0.8})
IN_SPAN = {"span": "[0, 1/2]", "times": np.linspace(0.01, 0.49, 9)}
SPRING_AND_DAMPING = (-a - b, -2 * (speed(a) + speed(b)), sp.Integer(0))

BASES = {
    "paper": Base(
        (a, b, c), (u,), SPRING_AND_DAMPING, (c - u * (a + b),), {u: third * sp.exp(t)},
        {a: (sp.Integer(1), half), b: (sp.Integer(2), -third), c: (sp.Integer(1), sp.Rational(19, 18))},
    ),
    "hoist": Base(
        (a, b), (u, w), (sp.Integer(-8), sp.Integer(0)), (a - u - w, b - u + w),
        {u: 1 + t - 2 * t**2, w: t - 2 * t**2},
        {a: (sp.Integer(1), sp.Integer(2)), b: (sp.Integer(1), sp.Integer(0))},
    ),
    "driven": Base(
        (a, b), (u, w), (-a, a), (a - u, b - w), {u: sp.cos(t), w: 1 - sp.cos(t)},
        {a: (sp.Integer(1), sp.Integer(0)), b: (sp.Integer(0), sp.Integer(0))},
    ),
    "beside the wall": Base(
        (a, b), (u,), (sp.Integer(-3), b), (a - u,), {u: 1 - 3 * t**2 / 2},
        {a: (sp.Integer(1), sp.Integer(0)), b: (half, third)},
    ),
    "two controls for one": Base(
        (a, b), (u, w), (-a, sp.Integer(0)), (a - u - w,), {u: sp.sin(t) + t, w: -t},
        {a: (sp.Integer(0), sp.Integer(1)), b: (half, third)},
    ),
    "rank lost under the law": Base(
        (a, b, c), (u,), (sp.Integer(0), sp.Integer(0), 1 + a), (b, b + u * c), {u: sp.Integer(0)},
        {a: (sp.Integer(1), sp.Integer(0)), b: (sp.Integer(0), sp.Integer(0)), c: (sp.Integer(0), sp.Integer(1))},
    ),
    "two weights on one floor": Base(
        (a, b), (u,), (sp.Integer(-1), sp.Integer(-2)), (a - u, b - u - 1), {u: sp.Integer(0)},
        {a: (sp.Integer(0), sp.Integer(0)), b: (sp.Integer(1), sp.Integer(0))}, universal=False,
    ),
    "pulled by another": Base(
        (a, b), (u,), (b**2, sp.Integer(0)), (a - u,), {u: sp.Integer(0)},
        {a: (sp.Integer(0), sp.Integer(0)), b: (sp.Integer(1), sp.Integer(0))}, universal=False,
    ),
    "paper, one motion": Base(
        (a, b, c), (u,), SPRING_AND_DAMPING, (c - u * (a + b),),
        {u: (1 + 2 * t) * sp.exp(t) / (3 + sp.Rational(19, 6) * t)},
        {a: (sp.Integer(1), half), b: (sp.Integer(2), -third), c: (sp.Integer(1), sp.Integer(2))},
    ),
    "force of either sign": Base(
        (a, b), (u,), (p, b), (a - u,), {u: 1 + p * t**2 / 2},
        {a: (sp.Integer(1), sp.Integer(0)), b: (half, third)}, values=BOTH_SIGNS,
    ),
    "size of a parameter": Base(
        (a, b), (u,), (p + sp.Abs(p), sp.Integer(0)), (a - u,), {u: 1 + (p + sp.Abs(p)) * t**2 / 2},
        {a: (sp.Integer(1), sp.Integer(0)), b: (half, third)}, values=BOTH_SIGNS,
    ),
    "growth of either sign": Base(
        (a, b, c), (u,), (-(p**2) * (a + b), -2 * p * (speed(a) + speed(b)), sp.Integer(0)), (c - u * (a + b),),
        {u: third * sp.exp(p * t)},
        {a: (sp.Integer(1), half), b: (sp.Integer(2), -half), c: (sp.Integer(1), p)}, values=BOTH_SIGNS,
    ),
    "law for one sign": Base(
        (a, b), (u,), (sp.Max(p, 0) * b + u * b**2, sp.Integer(0)), (a,), {u: sp.Integer(0)},
        {a: (sp.Integer(0), sp.Integer(0)), b: (half, third)}, values=({p: -0.8},),
    ),
    "root for one sign": Base(
        (a, b), (u,), ((u**2 - p) * b, sp.Integer(0)), (a,), {u: sp.sqrt(p)},
        {a: (sp.Integer(0), sp.Integer(0)), b: (half, third)}, values=({p: 1.3},),
    ),
    "none for either sign": Base(
        (a, b), (u,), (b**2 + sp.Abs(p), sp.Integer(0)), (a - u,), {u: sp.Integer(0)},
        {a: (sp.Integer(0), sp.Integer(0)), b: (sp.Integer(1), sp.Integer(0))}, universal=False, values=BOTH_SIGNS,
    ),
    "root": Base(
        (a, b), (u,), (((1 - t) * u**2 - 1) * b, sp.Integer(0)), (a,), {u: 1 / sp.sqrt(1 - t)},
        {a: (sp.Integer(0), sp.Integer(0)), b: (half, third)}, **IN_SPAN,
    ),
    "root of an integrating factor": Base(
        (a, b), (u,), (((1 - t**2) * speed(u) + t * u) * b, sp.Integer(0)), (a,), {u: sp.sqrt(1 - t**2)},
        {a: (sp.Integer(0), sp.Integer(0)), b: (half, third)}, **IN_SPAN,
    ),
    "logarithm": Base(
        (a, b), (u,), (((t - 1) * speed(u) - 1) * b, sp.Integer(0)), (a,), {u: sp.log(1 - t)},
        {a: (sp.Integer(0), sp.Integer(0)), b: (half, third)}, **IN_SPAN,
    ),
    "logarithm of a speed": Base(
        (a, b), (u,), (-(speed(a) ** 2), sp.Integer(0)), (a - u,), {u: sp.log(1 + t)},
        {a: (sp.Integer(0), sp.Integer(1)), b: (half, third)}, **IN_SPAN,
    ),
    "constraint that is lost": Base(
        (a, b, c), (u,), (b, sp.Integer(0), sp.Integer(0)), (a, u * b), {u: 1 + t},
        {a: (sp.Integer(0), sp.Integer(0)), b: (sp.Integer(0), sp.Integer(0)), c: (half, third)},
    ),
    "rank lost as the law moves": Base(
        (a, b, c), (u, w), (sp.Integer(2), sp.Integer(0), b), (a - w, a - w + u * c), {u: sp.Integer(0), w: t**2},
        {a: (sp.Integer(0), sp.Integer(0)), b: (half, third), c: (sp.Integer(0), sp.Integer(1))},
    ),
}  # fmt: skip

ONE_MOTION = {"paper, one motion"}
"""Bases whose law frees the motion from the state, not every motion."""
LIKE_OTHERS = {
    "beside the wall",
    "driven",
    "force of either sign",
    "logarithm of a speed",
    "root for one sign",
    "root of an integrating factor",
    "size of a parameter",
    "two controls for one",
    "two weights on one floor",
}
"""Bases of which another one is of the same kind."""


@dataclass(frozen=True)
class Hidden:
    """A base in other coordinates and controls: old ones in terms of new ones, and the other way."""

    base: Base
    coordinates: Change
    new_coordinates: Change
    controls: Change
    new_controls: Change

    def scene_file(self) -> str:
        base = self.base
        q, v = base.coordinates, [speed(x) for x in base.coordinates]
        rates = {speed(x): _rate(self.coordinates[x], q) for x in q}
        driven = {speed(x): _rate(self.controls[x], base.controls) for x in base.controls}
        old = {**self.coordinates, **self.controls, **rates, **driven}
        forces = [force.subs(old, simultaneous=True) for force in base.forces]
        generalized = [sum(f * self.coordinates[x].diff(y) for f, x in zip(forces, q, strict=True)) for y in q]
        energy = sum(rate**2 for rate in rates.values()) / 2
        start = {x: base.state[x][0] for x in q} | {speed(x): base.state[x][1] for x in q}
        positions = {x: self.new_coordinates[x].subs({**start, t: 0}) for x in q}
        motions = {speed(x): _rate(self.new_coordinates[x], q).subs(start).subs(t, 0) for x in q}
        state = [f"{x} = {maxima(value)}" for x, value in {**positions, **motions}.items()]
        given = [f"{x} = {maxima(value)}" for x, value in self.law.items()]
        return f"""
            load("holonom.mac")$
            system : holonomic_system(
              coordinates = [{", ".join(map(str, q))}], controls = [{", ".join(map(str, base.controls))}],
              parameters = [{", ".join(map(str, base.parameters))}],
              kinetic_energy = {maxima(energy.subs(dict(zip(v, v, strict=True))))},
              forces = [{", ".join(map(maxima, generalized))}],
              constraints = [{", ".join(maxima(f.subs(old, simultaneous=True)) for f in base.constraints)}])$
            hidden_scene : holonomic_scene(system, control_law = [{", ".join(given)}],
              {f"time_span = {base.span}," if base.span else ""}
              initial_state = [{", ".join(state)}])$
        """

    def mentions_all_controls(self) -> bool:
        """Whether each new control occurs in a constraint or force; one that does not is refused."""
        base = self.base
        old = {**self.controls, **{speed(x): _rate(self.controls[x], base.controls) for x in base.controls}}
        given = [sp.expand(f.subs(old, simultaneous=True)) for f in (*base.constraints, *base.forces)]
        names = set().union(*(f.free_symbols for f in given))
        return all({x, speed(x)} & names for x in base.controls)

    @property
    def law(self) -> Change:
        """The law of the old controls, as one of the new."""
        law = self.base.law
        return {x: sp.simplify(self.new_controls[x].subs(law, simultaneous=True)) for x in self.base.controls}


def _rate(expression: sp.Expr, q: Sequence[sp.Symbol]) -> sp.Expr:
    return expression.diff(t) + sum(expression.diff(x) * speed(x) for x in q)


def maxima(expression: sp.Expr) -> str:
    return str(expression).replace("**", "^").replace("Abs", "abs").replace("Max", "max")


def shears(names: Sequence[sp.Symbol], draw: random.Random, terms) -> tuple[Change, Change]:
    """A change of variables and its inverse: one variable after the other gains a function of the others."""
    old, new = {x: x for x in names}, {x: x for x in names}
    for _ in range(1 if len(names) > 2 else draw.choice([1, 2])):  # what Maxima still writes out
        x = draw.choice(names)
        gained = draw.choice(terms([y for y in names if y != x]))
        old = {y: value.subs(x, x + gained) for y, value in old.items()}
        new[x] = new[x] - gained.subs(new, simultaneous=True)
    return old, new


def hidden(base: Base, seed: int) -> Hidden:
    draw = random.Random(seed)
    size = draw.choice([1, 2, -1])
    q = shears(
        base.coordinates,
        draw,
        lambda others: [size * y for y in others] + [size * y**2 for y in others] + [size * t, 0 * t],
    )
    r = shears(base.controls, draw, lambda others: [size * y for y in others] + [t, t**2])
    if draw.random() < 1 / 3:
        x, factor = draw.choice(base.controls), draw.choice([1 + t**2, sp.exp(t), sp.Integer(3)])
        r = {y: value.subs(x, x * factor) for y, value in r[0].items()}, {**r[1], x: r[1][x] / factor}
    disguise = Hidden(base, *q, *r)
    return disguise if disguise.mentions_all_controls() else hidden(base, seed + 1000)


def contains(law: UniversalLaw, planted: Change, base: Base, values: Mapping[sp.Symbol, float]) -> bool:
    """Whether some constants make the planted law one of the family, for the values of the parameters."""
    symbols = real(" ".join(law.constants)) if law.constants else ()
    free = {sp.Symbol(name, real=True): planted[sp.Symbol(name, real=True)] for name in law.free}
    differences = [
        expression.subs(free) - planted[sp.Symbol(name, real=True)] for name, expression in law.controls.items()
    ]
    differences, positive = (
        sp.lambdify((t, *symbols), [e.subs(free).subs(values) for e in expressions], "numpy")
        for expressions in (differences, law.positive)
    )

    def residual(constants):
        return _along(differences(base.times, *constants), base)

    def holds(constants):
        with np.errstate(invalid="ignore"):
            return bool(np.all(_along(positive(base.times, *constants), base) > 0))

    starts = [[start] * len(symbols) for start in (1.0, -0.7)]
    if not any(map(holds, starts)):
        return False
    if not symbols:
        return bool(np.abs(residual([])).max(initial=0) < 1e-9)
    found = (least_squares(residual, start) for start in starts if holds(start))
    return any(fitted.cost < 1e-16 and holds(fitted.x) for fitted in found)


def _along(values: Sequence, base: Base) -> np.ndarray:
    return np.concatenate([np.zeros(0), *(np.broadcast_to(each, base.times.shape) for each in values)])


def require_no_false_verdict(name: str, seed: int, tmp_path: Path) -> None:
    disguise = hidden(BASES[name], seed)
    file = tmp_path / "hidden.mac"
    file.write_text(disguise.scene_file(), encoding="utf-8")
    found = free_motion(file, None, {}, Limits())
    universal = found.universal
    assert all(law.check.verdict is Verdict.AGREES for law in universal.laws)
    if not disguise.base.universal:
        assert universal.verdict in ("none", "undecided")
        return
    assert found.motion.verdict is not FreeMotionVerdict.NOT_FREE, found.motion
    if name in ONE_MOTION:
        return
    assert universal.verdict != "none", universal.reason
    for values in disguise.base.values:
        planted = {x: expression.subs(values) for x, expression in disguise.law.items()}
        found_laws = [law for law in universal.laws if contains(law, planted, disguise.base, values)]
        assert universal.verdict != "all" or found_laws, (planted, values)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.long] if name in LIKE_OTHERS else []) for name in BASES]
)
def test_no_change_of_coordinates_and_controls_makes_a_verdict_false(name, tmp_path):
    require_no_false_verdict(name, 1, tmp_path)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(2, 17))
@pytest.mark.parametrize("name", BASES)
def test_none_of_many_changes_makes_a_verdict_false(name, seed, tmp_path):
    require_no_false_verdict(name, seed, tmp_path)


def test_changes_are_undone_by_their_inverses():
    for name, base in BASES.items():
        for seed in range(20):
            disguise = hidden(base, seed)
            for old, new in (
                (disguise.coordinates, disguise.new_coordinates),
                (disguise.controls, disguise.new_controls),
            ):
                assert all(sp.simplify(old[x].subs(new, simultaneous=True) - x) == 0 for x in old), (name, seed)
