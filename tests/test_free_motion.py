"""Free motion, asked of Maxima, against the equations of motion written down here."""

import json
from pathlib import Path

import pytest
import sympy
from sympy import Function, Symbol, cos, exp, symbols

from harness.confined import Limits
from harness.failures import HolonomError
from harness.free_motion import free_motion

EXAMPLES = Path(__file__).parents[1] / "examples"
t = Symbol("t", real=True)


def asked(example: str, scene: str | None = None):
    return free_motion(EXAMPLES / f"{example}.mac", scene, {}, Limits())


def test_paper_universal_law_is_eq_15_and_the_only_one():
    universal = asked("paper/paper").universal
    u0 = Symbol("u0", real=True)
    assert universal.laws == ({"u": u0 * exp(t)},)
    assert universal.unique


def test_paper_trajectory_law_keeps_the_constraint_along_the_free_equations():
    found = asked("paper/paper").trajectory
    assert found.kind == "closed form"
    q1, q2, q3 = (found.motion[name] for name in ("q1", "q2", "q3"))
    assert sympy.simplify(q1.diff(t, 2) + q1 + q2) == 0
    assert sympy.simplify(q2.diff(t, 2) + 2 * (q1 + q2).diff(t)) == 0
    assert sympy.simplify(q3.diff(t, 2)) == 0
    assert sympy.simplify(q3 - found.law["u"] * (q1 + q2)) == 0


def test_pendulum_trajectory_law_is_the_distance_of_the_parabola():
    found = asked("pendulum", "lengthening_scene").trajectory
    x0, y0, vx, vy = symbols(["x_0", "y_0", "dot(x)_0", "dot(y)_0"], real=True)
    flight = (x0 + vx * t) ** 2 + (y0 + vy * t - sympy.Rational(981, 200) * t**2) ** 2
    assert sympy.expand(found.law["u"] ** 2 - flight) == 0


def test_bead_series_follows_the_free_slider():
    # free: M x'' = -m (x'' - projected), so the slider is pushed by the bead alone; solved here by sympy's own series
    found = asked("bead", "resting_scene").trajectory
    assert found.kind == "series"
    m, slider, w = 1, 3, 2
    x, r = Function("x")(t), Function("r")(t)
    energy = (slider * x.diff(t) ** 2) / 2 + m * (
        (x + r * cos(w * t)).diff(t) ** 2 + (r * sympy.sin(w * t)).diff(t) ** 2
    ) / 2
    residuals = [energy.diff(q.diff(t)).diff(t) - energy.diff(q) for q in (x, r)]
    a = symbols("a2:9")
    b = symbols("b2:9")
    trial_x = sum(coefficient * t**k for k, coefficient in enumerate(a, 2))
    trial_r = 1 + sum(coefficient * t**k for k, coefficient in enumerate(b, 2))
    known: dict = {}
    for order in range(len(a)):
        equations = [
            residual.subs({x: trial_x, r: trial_r}).doit().diff(t, order).subs(t, 0).subs(known)
            for residual in residuals
        ]
        known |= sympy.solve(equations, [a[order], b[order]])
    assert sympy.expand(found.law["u"] - trial_x.subs(known)) == 0


def test_cabin_is_free_in_parabolic_flight_and_not_in_a_lift():
    flight, lift = (asked("weightless_cabin", name) for name in ("parabolic_flight_scene", "lift_scene"))
    assert flight.verdict.satisfies == "all states"
    assert lift.verdict.satisfies == "no"
    assert lift.verdict.residual


def test_system_without_a_universal_law_says_so():
    universal = asked("pendulum").universal
    assert universal.laws == ()
    assert "no control can make" in universal.reason


def test_long_condition_is_refused_in_one_sentence():
    with pytest.raises(HolonomError, match="closed_form_size"):
        asked("andrews")


def test_json_has_the_stated_shape(capsys, monkeypatch):
    from harness.cli import main

    monkeypatch.setattr("sys.argv", ["holonom", "free", str(EXAMPLES / "paper/paper.mac"), "--json", "-"])
    with pytest.raises(SystemExit, match="0"):
        main()
    document = json.loads(capsys.readouterr().out)
    assert document["universal"] == {
        "laws": [{"u": "u0*exp(t)"}],
        "unique": True,
        "reason": document["universal"]["reason"],
    }
    assert document["law"]["satisfies"] == "no"
    assert document["trajectory"]["kind"] == "closed form"
