"""The command simulate: what it prints and writes, and the status it leaves with."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from contextlib import suppress
from functools import partial
from pathlib import Path

import pytest
from confinement import without_notice
from mpmath import cos, mp, mpf, sin
from refusing import message_of

from holonom.failures import ErrorKind
from holonom.processes import descendants

EXAMPLES = Path(__file__).parents[2] / "examples"
SIMULATE = [sys.executable, "-m", "holonom", "simulate"]
PENDULUM = EXAMPLES / "pendulum.mac"


@pytest.fixture
def simulate(holonom_here):
    return partial(holonom_here, "simulate")


def test_the_final_state_is_one_document(simulate):
    done = simulate(PENDULUM, "--final", "--json", "-")
    final = json.loads(done.stdout)
    assert (done.returncode, done.stderr) == (0, "")
    assert final["t"] == 10
    assert set(final["coordinates"]) == {"x", "y"}
    assert set(final["velocities"]) == {"dot(x)", "dot(y)"}
    assert set(final["multipliers"]) == {"lambda1"}
    assert {"position", "velocity", "acceleration"} == set(final["residuals"])
    assert isinstance(final["energy_error"], float)
    assert final["steps"] > 10
    assert final["engine"] == "taylor"
    assert "samples" not in final
    assert final["correction"] is None


def test_observed_controls_beyond_double_precision_ended_as_an_internal_error(simulate):
    """The shoulder's torque is that of inverse dynamics, 2 a'' + b'' cos(a - b) + b'^2 sin(a - b) + 2 g cos(a)."""
    done = simulate(EXAMPLES / "arm.mac", "--precision", "quadruple", "--until", "1", "--samples", "3", "--json", "-")
    assert (done.returncode, done.stderr) == (0, "")
    samples = json.loads(done.stdout)["samples"]
    with mp.workdps(36):
        g = mpf("9.81")
        for row in range(3):
            t, b, vb, torque = (mpf(samples[name][row]) for name in ("t", "b", "dot(b)", "tau1"))
            a, va, aa = sin(t) / 2 - 1, cos(t) / 2, -sin(t) / 2
            ab = va**2 * sin(a - b) - aa * cos(a - b) - g * cos(b)
            assert abs(2 * aa + ab * cos(a - b) + vb**2 * sin(a - b) + 2 * g * cos(a) - torque) < mpf("1e-31")


def test_a_simulation_waits_neither_for_sympy_nor_for_all_of_scipy():
    asked = ["simulate", str(PENDULUM), "--final", "--json", "-"]
    script = f"""
import sys
from holonom.cli.group import run
sys.argv[1:] = {asked}
run()
print({{'sympy', 'matplotlib', 'scipy.linalg', 'scipy.integrate'}} & sys.modules.keys())
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.endswith("}\nset()\n")


def test_without_final_the_document_holds_the_samples(simulate):
    found = json.loads(simulate(PENDULUM, "--samples", "3", "--json", "-").stdout)
    assert found["samples"]["t"] == [0, 5, 10]
    assert found["samples"]["x"][-1] == found["coordinates"]["x"]


def test_longer_numbers_are_decimal_text(simulate):
    final = json.loads(simulate(PENDULUM, "--precision", "40", "--until", "1", "--final", "--json", "-").stdout)
    assert isinstance(final["coordinates"]["x"], str)
    assert len(final["coordinates"]["x"]) > 40


def test_a_table_shows_the_end_and_how_well_it_was_reached(simulate):
    done = simulate(PENDULUM)
    assert done.returncode == 0
    assert "lambda1" in done.stdout
    assert "taylor" in done.stdout
    assert "\x1b" not in done.stdout
    assert done.stderr == ""


def test_samples_and_figures_are_written(tmp_path, simulate):
    samples, vector, pixels = (tmp_path / name for name in ("swing.csv", "swing.svg", "swing.png"))
    assert simulate(PENDULUM, "-o", samples, "--plot", vector).returncode == 0
    assert simulate(PENDULUM, "--plot", pixels).returncode == 0
    assert samples.read_text().startswith("t,x,y,dot(x),dot(y),lambda1\n0.0,")
    assert "multipliers" in vector.read_text()
    assert pixels.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--tol", "1e-30"], message_of(ErrorKind.TOLERANCE_OUT_OF_RANGE, "1e-30")),
        (["--until", "-1"], message_of(ErrorKind.NOT_AFTER_START)),
        (["--precision", "single"], message_of(ErrorKind.NOT_A_PRECISION, "single")),
        (["-o", "motion.xls"], message_of(ErrorKind.NO_SUCH_FORMAT, ".csv, .npz, .parquet")),
        (["--plot", "motion.pdf"], message_of(ErrorKind.NO_SUCH_FORMAT, ".svg, .png")),
        (["-o", "/dev/full/motion.csv"], message_of(ErrorKind.UNWRITABLE)),
        (["--scene", "no_scene"], message_of(ErrorKind.NO_SUCH_SCENE, "no_scene")),
    ],
)
def test_bad_input_is_one_sentence(options, message, tmp_path, monkeypatch, simulate):
    monkeypatch.chdir(tmp_path)
    done = simulate(PENDULUM, *options)
    assert done.returncode == 2
    assert re.search(message, done.stderr)
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""
    assert list(tmp_path.iterdir()) == []


def test_a_start_of_limited_digits_was_corrected_without_a_word(write_scene, simulate):
    scene = write_scene(
        """load("holonom.mac")$
        system : holonomic_system(
          coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2, constraints = [x^2 + y^2 - 1])$
        scene : holonomic_scene(system,
          initial_state = [x = 0.70710678118, y = 0.70710678118, dot(x) = 0], time_span = [0, 1])$"""
    )
    done = simulate(scene, "--json", "-")
    missed = (0.5**0.5 - 0.70710678118) * 10**12
    assert float(json.loads(done.stdout)["correction"]["size"]) * 10**12 == pytest.approx(missed, rel=1e-3)
    assert re.search("(?m)^The .* initial state .*correct", simulate(scene).stdout)


def test_a_scene_without_an_end_is_refused(particle_scene, simulate):
    done = simulate(particle_scene)
    assert done.returncode == 2
    assert re.search(message_of(ErrorKind.NO_END), done.stderr)
    assert simulate(particle_scene, "--until", "1").returncode == 0


def writes_below(pid: int, folder: Path) -> bool:
    """Return True if a process below this one has a file open in a folder, perhaps one without a name."""
    for each in descendants(pid):
        with suppress(OSError):
            for descriptor in Path(f"/proc/{each}/fd").iterdir():
                if descriptor.readlink().is_relative_to(folder):
                    return True
    return False


def test_an_interrupted_run_leaves_no_file(tmp_path):
    samples = tmp_path / "swing.csv"
    command = [*SIMULATE, str(PENDULUM), "--until", "100000000", "--samples", "2", "-o", str(samples)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    while process.poll() is None and not writes_below(process.pid, tmp_path):  # what will be its samples
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60)
    assert process.returncode == 130
    assert list(tmp_path.iterdir()) == []


def test_heyoka_was_called_not_installed_where_memory_was_short(tmp_path):
    package = tmp_path / "heyoka"
    package.mkdir()
    (package / "__init__.py").write_text('raise ImportError("core.so: failed to map segment from shared object")')
    asked = [*SIMULATE, str(PENDULUM), "--until", "1"]
    environment = os.environ | {"PYTHONPATH": str(tmp_path)}
    done = subprocess.run(asked, capture_output=True, text=True, timeout=120, env=environment)
    assert (done.returncode, without_notice(done.stderr).count("\n")) == (3, 1)
    assert re.search(message_of(None, "memory"), done.stderr)
