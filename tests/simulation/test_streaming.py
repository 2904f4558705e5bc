"""Samples that are written as they come: equal to those in memory, in the memory of a few of them."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from problems import problem
from pyarrow import parquet
from refusing import failing

from holonom.failures import ErrorKind, HolonomError
from holonom.program.motion_problem import MotionProblem
from holonom.simulation import output, recording
from holonom.simulation.output import _write_samples, require_disk, sample_file
from holonom.simulation.request import SimulationRequest
from holonom.simulation.result import Sampled
from holonom.simulation.simulate import _EnergyStatistics, integrate, simulate

SAMPLES = 50
LARGER = 20e6
"""Bytes that a run of five times as many samples may take beyond the other: half of what their numbers alone take."""


@pytest.fixture(scope="module")
def lengthening() -> MotionProblem:
    """A control does work on it: energies are compared at every sample."""
    return problem("pendulum.mac", "lengthening_scene")


@pytest.fixture
def short_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(recording, "BLOCK", 7)
    monkeypatch.setattr(recording, "PORTION", 3)


def simulated(asked: MotionProblem, **wanted) -> list[Sampled]:
    parts: list[Sampled] = []
    integrate(asked, SimulationRequest(until=3, **wanted), parts.append)
    return parts


@pytest.mark.parametrize("wanted", [{"samples": SAMPLES}, {"max_step": 0.05}], ids=["samples", "steps"])
def test_blocks_are_the_motion_and_none_is_longer_than_it_may_be(lengthening, short_blocks, wanted):
    parts = simulated(lengthening, **wanted)
    together = np.concatenate([part.times for part in parts])
    assert max(len(part.times) for part in parts) <= recording.BLOCK < len(together)
    assert together[0] == 0
    assert together[-1] == 3
    assert (np.diff(together) > 0).all()
    if "samples" in wanted:
        assert together == pytest.approx(np.linspace(0, 3, SAMPLES), abs=1e-15)


def test_the_report_does_not_depend_on_the_blocks(lengthening, monkeypatch):
    whole = simulate(lengthening, SimulationRequest(until=3, samples=SAMPLES))
    monkeypatch.setattr(recording, "BLOCK", 7)
    monkeypatch.setattr(recording, "PORTION", 3)
    parts = simulate(lengthening, SimulationRequest(until=3, samples=SAMPLES))
    for (name, samples), (_, others) in zip(whole.columns(), parts.columns(), strict=True):
        assert others == pytest.approx(samples, abs=1e-13), name
    assert parts.report.energy_error == pytest.approx(whole.report.energy_error, abs=1e-13)
    assert parts.report.violations == whole.report.violations == ()


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_a_file_written_in_parts_holds_what_one_written_at_once_does(lengthening, short_blocks, tmp_path, suffix):
    parts = simulated(lengthening, samples=SAMPLES)
    with sample_file(tmp_path / f"parts{suffix}", 17) as take:
        for part in parts:
            take(part)
    _write_samples(simulate(lengthening, SimulationRequest(until=3, samples=SAMPLES)), tmp_path / f"whole{suffix}")
    read = parquet.read_table if suffix == ".parquet" else Path.read_text
    assert read(tmp_path / f"parts{suffix}") == read(tmp_path / f"whole{suffix}")


@pytest.mark.parametrize("suffix", [".csv", ".npz", ".parquet"])
def test_a_motion_that_breaks_off_leaves_no_file(lengthening, tmp_path, suffix):
    (part,) = simulated(lengthening, samples=5)
    file = tmp_path / f"broken{suffix}"
    with failing(ErrorKind.NO_WAY_ON):
        broken_off(part, file)
    assert list(tmp_path.iterdir()) == []


def broken_off(part: Sampled, file: Path) -> None:
    with sample_file(file, 17) as take:
        take(part)
        raise HolonomError(ErrorKind.NO_WAY_ON, detail="1")


def test_more_than_the_disk_holds_is_refused_before_the_motion(lengthening, tmp_path):
    require_disk(lengthening, SAMPLES, tmp_path / "swing.csv")
    with failing(ErrorKind.DISK_TOO_SMALL, str(10**15)):
        require_disk(lengthening, 10**15, tmp_path / "swing.parquet")


@pytest.mark.parametrize("suffix", output.BYTES_ON_DISK)
def test_a_sample_takes_no_more_of_the_disk_than_is_stated(lengthening, tmp_path, suffix):
    simulation = simulate(lengthening, SimulationRequest(until=3, samples=3000))
    file = tmp_path / f"swing{suffix}"
    _write_samples(simulation, file)
    numbers = sum(len(column) for _, column in simulation.columns())
    assert 0.5 < file.stat().st_size / (numbers * output.BYTES_ON_DISK[suffix]) <= 1.1


def test_an_energy_that_is_no_number_is_not_passed_over():
    """Of a larger number and none, max() in Python takes the first."""
    energy_statistics = _EnergyStatistics()
    energy_statistics.add(np.array([2.0]), np.array([0.5]))
    energy_statistics.add(np.array([np.nan]), np.array([np.nan]))
    energy_statistics.add(np.array([2.0]), np.array([0.5]))
    assert np.isnan([energy_statistics.largest_change, energy_statistics.error]).all()


@pytest.mark.long
@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_memory_does_not_grow_with_the_number_of_samples(tmp_path, suffix):
    fewer, more = (peak_memory(tmp_path / f"{samples}{suffix}", samples) for samples in (200_000, 1_000_000))
    assert more - fewer < LARGER


def peak_memory(file: Path, samples: int) -> int:
    """Bytes that a process which follows a motion to a file takes at most."""
    program = (
        "import resource, sys; from pathlib import Path; from problems import problem\n"
        "from holonom.simulation.output import sample_file; from holonom.simulation.request import SimulationRequest\n"
        "from holonom.simulation.simulate import integrate\n"
        "asked = problem('pendulum.mac', 'swing_scene')\n"
        "with sample_file(Path(sys.argv[1]), 17) as take:\n"
        "    integrate(asked, SimulationRequest(until=3, samples=int(sys.argv[2])), take)\n"
        "print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, str(file), str(samples)],
        cwd=Path(__file__).parent,
        capture_output=True,
        text=True,
        check=True,
    )
    unit = 1 if sys.platform == "darwin" else 1024
    return int(done.stdout) * unit
