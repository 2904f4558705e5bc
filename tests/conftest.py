"""What several tests need: a place to write a scene, and a record small enough to read."""

import os
import shutil
import signal
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest
from particle import PARTICLE

from holonom.documents import Document, ask

# As the command line has it, and every process that the tests start: with threads of its own in each of the tests'
# processes, BLAS takes ten times as long. NumPy reads this when it is first imported, which is later.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# What starts the tests in the background has them ignore these signals, and the commands that they start as well.
for number, handler in ((signal.SIGINT, signal.default_int_handler), (signal.SIGHUP, signal.SIG_DFL)):
    if signal.getsignal(number) is signal.SIG_IGN:
        signal.signal(number, handler)

ScenesWriter = Callable[[str], Path]
COMPANION = Path(__file__).with_name("companion")


@pytest.fixture(scope="session")
def gsl() -> None:
    """The GNU Scientific Library, which the Runge-Kutta engine needs and nothing else does."""
    if shutil.which("gsl-config") is None:
        pytest.skip("the GNU Scientific Library is not installed")


@pytest.fixture
def write_scene(tmp_path: Path) -> ScenesWriter:
    """Put Maxima text into a file of its own."""

    def write(text: str) -> Path:
        file = tmp_path / "scene.mac"
        file.write_text(text, encoding="utf-8")
        return file

    return write


@pytest.fixture
def particle_scene(write_scene: ScenesWriter) -> Path:
    return write_scene(PARTICLE)


@pytest.fixture(scope="session")
def particle_record(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The particle's record as Maxima wrote it."""
    file = tmp_path_factory.mktemp("particle") / "scene.mac"
    file.write_text(PARTICLE, encoding="utf-8")
    return ask(Document.RECORD, file)


def pytest_xdist_auto_num_workers() -> int:
    """One more than there are cores: some tests wait, for a browser, a signal, or the end of a time limit."""
    return (os.cpu_count() or 1) + 1


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """On several cores: the tests of a file stay together, and so do those that read the companion, made once."""
    for item in items:
        group = "companion" if COMPANION in item.path.parents else item.path.stem
        item.add_marker(pytest.mark.xdist_group(group))


def pytest_terminal_summary(terminalreporter) -> None:
    """Tell how many pairs of Maxima's own test files passed, one test a file for pytest, and why tests were skipped."""
    properties = [dict(report.user_properties) for report in terminalreporter.getreports("passed")]
    counts = [found["maxima_tests"] for found in properties if "maxima_tests" in found]
    if counts:
        terminalreporter.write_line(f"Maxima's own tests: {sum(counts)} passed in {len(counts)} files")
    reasons = Counter(report.longrepr[2] for report in terminalreporter.getreports("skipped"))
    for reason, count in reasons.items():
        terminalreporter.write_line(f"{reason} ({count} tests)")
