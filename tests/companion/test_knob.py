"""The page of the knob: its script follows the motion as NumPy does, and its circle is that of the closed form."""

import cmath
import json
import shutil
import subprocess

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from holonom.companion.chapter import chapters_of_the_paper
from holonom.companion.directives import FILES
from holonom.companion.further_runs import LAWS
from holonom.program.numpy_function import NumpyFunction

NODE = shutil.which("node")
pytestmark = pytest.mark.skipif(NODE is None, reason="no script was run: node is not installed")
RUNS = chapters_of_the_paper()["turn-the-knob"].runs
SETTINGS = {
    "u0": 0.7,
    "omega": 2.0,
    "kappa": 0.8,
    "k": 1.3,
    "c": 1.2,
    "q1": 1.0,
    "q2": -0.4,
    "dot(q1)": 0.5,
    "dot(q2)": 1.0,
}
UNTIL, SAMPLES = 2.0, 21
RUN = """
const knob = require(process.argv[1]);
const [settings, until, samples] = JSON.parse(process.argv[2]);
console.log(JSON.stringify({seen: knob.follow(settings, until, samples), radius: knob.radius(settings)}));
"""


@pytest.fixture(scope="module")
def simulated(companion):
    def follow(law, **changed):
        given = json.dumps([{**SETTINGS, "law": law, **changed}, UNTIL, SAMPLES])
        done = subprocess.run(
            [NODE, "-e", RUN, str(companion / FILES / "knob.js"), given], capture_output=True, text=True, check=True
        )
        return json.loads(done.stdout)

    return follow


@pytest.fixture(scope="module")
def known_models(results):
    return results[RUNS["models"]]


@pytest.mark.parametrize("law", LAWS)
def test_the_script_follows_the_motion_as_numpy_does(simulated, known_models, law):
    model = known_models[law]
    motion, controls = NumpyFunction(model.motion), NumpyFunction(model.law)

    def values(t, state):
        names = ("q1", "q2", "q3", "dot(q1)", "dot(q2)", "dot(q3)")
        known = {**SETTINGS, "t": t, **dict(zip(names, state, strict=True))}
        found = controls(np.array([known[name] for name in model.law.inputs]))
        known |= dict(zip(model.law.outputs, found, strict=True))
        found = motion(np.array([known[name] for name in model.motion.inputs]))
        return known | dict(zip(model.motion.outputs, found, strict=True))

    def rate(t, state):
        found = values(t, state)
        return [*state[3:], *(found[f"ddot(q{k})"] for k in (1, 2, 3))]

    q1, q2, v1, v2 = (SETTINGS[name] for name in ("q1", "q2", "dot(q1)", "dot(q2)"))
    first = values(0.0, [q1, q2, 0, v1, v2, 0])
    start = [q1, q2, first["u"] * (q1 + q2), v1, v2, first["dot(u)"] * (q1 + q2) + first["u"] * (v1 + v2)]
    truth = solve_ivp(rate, (0, UNTIL), start, "DOP853", np.linspace(0, UNTIL, SAMPLES), rtol=1e-12, atol=1e-12)
    seen = simulated(law)["seen"]
    for k, state in enumerate(truth.y.T):
        expected = values(truth.t[k], state)
        power = expected["lambda1"] * expected["dot(u)"] * (expected["q1"] + expected["q2"])
        for name in ("q1", "q2", "q3", "lambda1"):
            assert seen[k][name] == pytest.approx(expected[name], abs=1e-6)
        assert seen[k]["power"] == pytest.approx(power, abs=1e-6)


def test_the_circle_is_that_of_the_zeros_of_the_denominator(simulated):
    """1 + 2 u^2 = 0 at t = -u0 + i/sqrt(2) under u0 + t, at arccos(i/(sqrt(2) u0))/omega under u0 cos(omega t)."""
    u0, omega = SETTINGS["u0"], SETTINGS["omega"]
    assert simulated("linear")["radius"] == pytest.approx((u0**2 + 0.5) ** 0.5, rel=1e-9)
    assert simulated("swinging")["radius"] == pytest.approx(abs(cmath.acos(1j / (2**0.5 * u0))) / omega, rel=1e-9)
    exponential = abs(cmath.log(1j / (2**0.5 * u0))) / SETTINGS["kappa"]
    assert simulated("exponential")["radius"] == pytest.approx(exponential, rel=1e-9)


def test_a_slow_law_has_a_wide_circle(simulated):
    assert simulated("exponential", kappa=0.1)["radius"] == pytest.approx(
        8 * simulated("exponential")["radius"], rel=1e-9
    )
    assert simulated("exponential", kappa=0.0)["radius"] is None


@pytest.mark.parametrize("kappa", [1.0, -1.0, 1.5])
def test_every_motion_is_free_where_the_root_is_double(simulated, kappa):
    found = simulated("exponential", kappa=kappa, k=kappa**2, c=2 * kappa)
    assert max(abs(each["lambda1"]) for each in found["seen"]) < 1e-12
    assert found["radius"] is None  # JSON has no infinity


def test_the_paper_s_damping_is_singled_out_by_a_proof(results):
    assert results[RUNS["paper"]].motion.verdict == "free"
    assert results[RUNS["other"]].motion.verdict == "not free"


def test_a_knob_that_rocks_twice_as_fast_has_half_the_circle(simulated):
    assert simulated("swinging", omega=4.0)["radius"] == pytest.approx(simulated("swinging")["radius"] / 2, rel=1e-9)
