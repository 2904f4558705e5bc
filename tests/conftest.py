"""What several tests need: a place to write a scene, and a record small enough to read."""

import os
import shutil
import signal
from collections import Counter
from collections.abc import Callable, Generator
from contextlib import redirect_stderr, redirect_stdout
from io import BytesIO, TextIOWrapper
from pathlib import Path
from subprocess import CompletedProcess
from threading import Thread

import pytest
from confinement import without_notice
from hypothesis import HealthCheck, settings
from particle import PARTICLE

from holonom.cli import run
from holonom.documents import ask
from holonom.errata import PrintedEquation, errata
from holonom.failures import ErrorKind, HolonomError
from holonom.formats import Document
from holonom.sandbox import Limits

# As the command line has it, and every process that the tests start: with threads of its own in each of the tests'
# processes, BLAS takes ten times as long. NumPy reads this when it is first imported, which is later.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# What starts the tests in the background has them ignore these signals, and the commands that they start as well.
for number, handler in ((signal.SIGINT, signal.default_int_handler), (signal.SIGHUP, signal.SIG_DFL)):
    if signal.getsignal(number) is signal.SIG_IGN:
        signal.signal(number, handler)

# Hypothesis draws the same examples in each run, and none is too slow on a busy machine.
settings.register_profile("patient", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("patient")

ScenesWriter = Callable[[str], Path]
# Fixtures that take long, and are made once: the group of all tests that ask for them.
MADE_ONCE = {"results": "companion", "browser": "companion", "printed_equations": "errata"}
# Fixtures that take long, and with them all tests that ask for them.
LONG = {"results", "objects", "programs", "own", "partners", "reference", "first_made"}
# Tests that took more than a second of processor time: a function, or one of its cases.
MEASURED = frozenset(Path(__file__).with_name("measured.txt").read_text(encoding="utf-8").splitlines())
LONGEST = (
    "companion",
    "test_rtests",
    "test_servo_constraints",
    "test_escapes",
    "test_free_motion",
    "test_preloaded",
    "test_rows",
    "test_power_series",
    "test_switching",
    "test_effects",
    "test_initial_state",
    "test_register",
    "test_rigid_bodies",
    "test_inverse_problem",
    "test_study",
    "test_own_scenes",
    "test_vanishing_pivots",
    "test_tampering",
    "test_special_functions",
    "test_truths",
    "test_linearization",
    "test_program_verdicts",
    "test_names",
    "test_random_systems",
    "test_redundancy",
    "test_wheel",
    "errata",
)


EXAMPLE = Path(__file__).parents[1] / "examples" / "pendulum.mac"
LACKING = pytest.StashKey[frozenset[ErrorKind]]()


def pytest_configure(config: pytest.Config) -> None:
    """Find out what this machine lacks; without Maxima nothing can be tested."""
    if shutil.which("maxima") is None:
        raise pytest.UsageError(HolonomError(ErrorKind.MAXIMA_MISSING).message())
    from holonom.maxima import get_ready
    from holonom.program.c_function import has_compiler

    if config.getoption("numprocesses", None) and not hasattr(config, "workerinput"):
        # The image of Maxima is made while the workers collect; without it each run of theirs loads the library.
        Thread(target=get_ready, args=(EXAMPLE, Limits())).start()
    config.stash[LACKING] = frozenset() if has_compiler() else frozenset({ErrorKind.COMPILER_MISSING})


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo) -> Generator[None, pytest.TestReport]:
    """A test that is refused what this machine lacks is skipped, for that reason."""
    report = yield
    error = call.excinfo.value if call.excinfo else None
    if isinstance(error, HolonomError) and error.kind in item.config.stash[LACKING]:
        report.outcome, report.longrepr = "skipped", (str(item.path), item.location[1], f"Skipped: {error.reason}")
    return report


@pytest.fixture(scope="session")
def c_compiler(pytestconfig: pytest.Config) -> None:
    """The system's C compiler."""
    if ErrorKind.COMPILER_MISSING in pytestconfig.stash[LACKING]:
        raise HolonomError(ErrorKind.COMPILER_MISSING)


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


@pytest.fixture
def holonom_here(monkeypatch: pytest.MonkeyPatch) -> Callable[..., CompletedProcess[str]]:
    """Runs a command in this process, which has loaded its libraries; what it prints, and its status."""

    def run_here(*arguments: str | Path) -> CompletedProcess[str]:
        out, err = (TextIOWrapper(BytesIO(), encoding="utf-8") for _ in range(2))
        monkeypatch.setattr("sys.argv", ["holonom", *map(str, arguments)])
        monkeypatch.setattr("holonom.cli.motion.OWN_PROCESS", None)  # other things run in this one
        with redirect_stdout(out), redirect_stderr(err):
            status = run()
        printed = []
        for stream in (out, err):
            stream.flush()
            printed.append(stream.buffer.getvalue().decode())
        return CompletedProcess(arguments, status, printed[0], without_notice(printed[1]))

    return run_here


@pytest.fixture(scope="session")
def particle_record(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The particle's record as Maxima wrote it."""
    file = tmp_path_factory.mktemp("particle") / "scene.mac"
    file.write_text(PARTICLE, encoding="utf-8")
    return ask(Document.RECORD, file)


@pytest.fixture(scope="session")
def printed_equations() -> tuple[PrintedEquation, ...]:
    """The paper as printed, compared with the derivation."""
    return errata()


def pytest_xdist_auto_num_workers() -> int:
    """One more than there are cores: some tests wait, for a browser, a signal, or the end of a time limit."""
    return (os.cpu_count() or 1) + 1


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """On several cores: the tests of a file stay together, and so do those of a fixture that is made once.

    Those that take longest come first, then files with many tests, so that no core waits for a last long one.
    """
    groups = {item: _group(item) for item in items}
    sizes = Counter(groups.values())
    for item, group in groups.items():
        item.add_marker(pytest.mark.xdist_group(group))
        if LONG.intersection(item.fixturenames):
            item.add_marker(pytest.mark.long)
        if MEASURED.intersection({item.nodeid, item.nodeid.partition("[")[0]}):
            item.add_marker(pytest.mark.long)
            item.add_marker(pytest.mark.measured)
    if hasattr(config, "workerinput"):
        items.sort(key=lambda item: (_rank(groups[item]), -sizes[groups[item]], groups[item]))


def _group(item: pytest.Item) -> str:
    return next((MADE_ONCE[name] for name in item.fixturenames if name in MADE_ONCE), item.path.stem)


def _rank(group: str) -> int:
    return LONGEST.index(group) if group in LONGEST else len(LONGEST)


def pytest_terminal_summary(terminalreporter) -> None:
    """Tell how many pairs of Maxima's own test files passed, one test a file for pytest, and why tests were skipped."""
    properties = [dict(report.user_properties) for report in terminalreporter.getreports("passed")]
    counts = [found["maxima_tests"] for found in properties if "maxima_tests" in found]
    if counts:
        terminalreporter.write_line(f"Maxima's own tests: {sum(counts)} passed in {len(counts)} files")
    reasons = Counter(report.longrepr[2] for report in terminalreporter.getreports("skipped"))
    for reason, count in reasons.items():
        terminalreporter.write_line(f"{reason} ({count} tests)")
