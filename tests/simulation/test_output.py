"""Files of samples hold what the simulation holds; a file is whole or not there."""

import csv
from pathlib import Path

import numpy as np
import pytest
from problems import problem
from pyarrow import parquet
from refusing import failing

from holonom.failures import ErrorKind
from holonom.simulation.output import _write_samples, streams
from holonom.simulation.request import SimulationRequest
from holonom.simulation.result import Simulation
from holonom.simulation.simulate import simulate


@pytest.fixture(scope="module")
def swing() -> Simulation:
    return simulate(problem("pendulum.mac", "swing_scene"), SimulationRequest(samples=7))


@pytest.fixture(scope="module")
def quadruple_swing() -> Simulation:
    return simulate(problem("pendulum.mac", "swing_scene", 36), SimulationRequest(samples=3, precision="quadruple"))


def read_csv(path: Path) -> dict:
    names, *rows = csv.reader(path.open())
    return dict(zip(names, zip(*rows, strict=True), strict=True))


READERS = {
    ".csv": read_csv,
    ".npz": lambda path: dict(np.load(path)),
    ".parquet": lambda path: parquet.read_table(path).to_pydict(),
}


@pytest.mark.parametrize("suffix", READERS)
def test_samples_are_read_back_to_the_last_bit(swing, tmp_path, suffix):
    path = tmp_path / f"swing{suffix}"
    _write_samples(swing, path)
    read = READERS[suffix](path)
    assert list(read) == ["t", "x", "y", "dot(x)", "dot(y)", "lambda1"]
    for name, samples in swing.columns():
        assert [float(text) for text in read[name]] == samples.tolist()


def test_arrays_of_numpy_are_written_at_once_and_other_formats_sample_by_sample():
    assert [streams(Path(f"swing{suffix}")) for suffix in READERS] == [True, False, True]


@pytest.mark.parametrize("suffix", READERS)
def test_more_digits_than_a_double_has_are_text(quadruple_swing, tmp_path, suffix):
    path = tmp_path / f"swing{suffix}"
    _write_samples(quadruple_swing, path)
    last = str(READERS[suffix](path)["x"][-1])
    assert len(last) > 34
    assert abs(float(last) - float(quadruple_swing.coordinates["x"][-1])) < 1e-16


@pytest.mark.parametrize("name", ["swing.xlsx", "swing"])
def test_an_unknown_format_is_refused(swing, tmp_path, name):
    with failing(ErrorKind.NO_SUCH_FORMAT, ".csv, .npz, .parquet"):
        _write_samples(swing, tmp_path / name)


@pytest.mark.parametrize("suffix", READERS)
def test_a_file_that_cannot_be_written_is_not_there(swing, tmp_path, suffix):
    with failing(ErrorKind.UNWRITABLE):
        _write_samples(swing, tmp_path / "missing" / f"swing{suffix}")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="the system has no device that is always full")
def test_a_full_disk_is_one_sentence(swing, tmp_path):
    path = tmp_path / "swing.csv"
    path.symlink_to("/dev/full")
    with failing(ErrorKind.DISK_FULL, "No space left on device"):
        _write_samples(swing, path)
