"""What is particular to heyoka: expressions for its integrators."""

import os
import subprocess
import sys

import heyoka
import numpy as np
import pytest
from programs import PENDULUM, chain, program
from refusing import failing

from holonom.failures import ErrorKind
from holonom.program.heyoka_function import dynamics, heyoka_expressions, import_heyoka

GRAVITY = {"g": heyoka.expression(9.81)}


def test_pendulum_keeps_energy_and_length():
    """Truth: along the exact motion both are constant; heyoka integrates to machine precision."""
    integrator = heyoka.taylor_adaptive(dynamics(PENDULUM, GRAVITY), [0.6, -0.8, 0.4, 0.3])
    integrator.propagate_until(3.0)
    x, y, dx, dy = integrator.state
    assert x**2 + y**2 == pytest.approx(1, abs=1e-12)
    assert (dx**2 + dy**2) / 2 + 9.81 * y == pytest.approx(0.125 - 9.81 * 0.8, abs=1e-11)


def test_state_is_coordinates_then_velocities():
    assert [str(symbol) for symbol, _ in dynamics(PENDULUM, GRAVITY)] == ["x", "y", "dot(x)", "dot(y)"]


def test_control_law_is_a_function_of_time():
    """Truth: a mass on a string reeled in along its own direction, without gravity, has ddot(x1) = ddot(u)."""
    t = heyoka.time
    law = {"u": 1.0 + t**2.0, "dot(u)": 2.0 * t, "ddot(u)": heyoka.expression(2.0), "g": heyoka.expression(0.0)}
    integrator = heyoka.taylor_adaptive(dynamics(chain(1), law), [1.0, 0.0, 0.0, 0.0])
    integrator.propagate_until(1.0)
    assert integrator.state == pytest.approx([2.0, 0.0, 2.0, 0.0], abs=1e-12)


@pytest.mark.parametrize("n", [3, 4, 7])
def test_powers_of_what_is_zero_were_no_numbers(n):
    """Truth: ddot(x) = (t - x)^n starts as t^n. heyoka's own powers beyond squares divide by their base."""
    assignments = [("w1", ["Power", ["Subtract", "t", "x"], n])]
    fall = program(["t", "x", "dot(x)"], assignments, {"ddot(x)": "w1"})
    integrator = heyoka.taylor_adaptive(dynamics(fall, {}), [0.0, 0.0])
    integrator.propagate_until(1 / 64)
    assert integrator.state[0] == pytest.approx(2.0 ** (-6 * (n + 2)) / ((n + 1) * (n + 2)), rel=1e-3)


def test_rationals_take_the_precision_asked_for():
    number = np.longdouble if np.finfo(np.longdouble).eps < np.finfo(float).eps else float
    third = heyoka_expressions(
        PENDULUM, {name: heyoka.expression(name) for name in PENDULUM.inputs}, lambda q: number(q.numerator)
    )
    assert set(third) == set(PENDULUM.outputs)


def test_a_missing_control_law_is_named():
    with failing(ErrorKind.INPUT_MISSING, "g"):
        dynamics(PENDULUM, {})


def test_a_missing_extra_is_one_sentence_that_names_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "heyoka", None)
    with failing(ErrorKind.EXTRA_MISSING, "heyoka"):
        import_heyoka()


def test_machine_code_is_not_written_to_the_home_directory(tmp_path):
    compiling = "from holonom.program.heyoka_function import import_heyoka; heyoka = import_heyoka(); "
    compiling += "x = heyoka.expression('x'); heyoka.cfunc([heyoka.sin(x)], vars=[x])"
    home = os.environ | {"HOME": str(tmp_path), "XDG_CACHE_HOME": str(tmp_path / "cache")}
    done = subprocess.run([sys.executable, "-c", compiling], env=home, capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout, list(tmp_path.rglob("*"))) == (0, "", [])
