"""What the simulations are held to, and how far that holds; one-shot runs and many digits."""

import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import mpmath
from simulation_motions import Motion, paper_in_mpmath
from simulation_peers import DOP853, HEYOKA, OLDER_SCIPY, SOLVE_IVP, SUNDIALS, start_of
from timing import as_installed

from holonom.benchmark.work_precision.engines import prepare_taylor
from holonom.benchmark.work_precision.measurement import State, relative_error
from holonom.benchmark.work_precision.reference import find_reference
from holonom.program.motion_problem import DOUBLE_DIGITS, MotionProblem, motion_problem, problem_document
from holonom.program.request import Request
from holonom.program.timing import python_batch, shortest_times
from holonom.sandbox import Limits
from holonom.simulation.derivations import open_names
from holonom.simulation.request import EngineName, SimulationRequest, Stabilization
from holonom.simulation.simulate import simulate

if TYPE_CHECKING:
    from simulation import Row

BY_HEYOKA, BEST_BY_HAND, SUNDIALS_TIMES = 1.25, 1.1, 12.0
SCIPY_TIMES = {"paper": 100.0, "pendulum": 100.0, "chain_8": 12.0, "car_axis": 12.0, "andrews": 12.0}
ONE_SHOT, HELP, LOADING = 0.5, 0.1, 0.2  # of the time of SymPy and solve_ivp; seconds; seconds
MAXIMA_SECONDS = {"andrews": 0.45}
RESIDUAL, PROJECTION_SHARE = 1e-12, 0.25
MPMATH_TIMES, MPMATH_DIGITS = 300.0, 30
OUR_DIGITS, OUR_TOLERANCE = "34", 1e-34

ONE_SHOT_REPEATS = 3
TOLERANCE = "1e-9"  # of one-shot runs
ENGINES = TAYLOR, RUNGE_KUTTA = "Holonom, Taylor", "Holonom, Runge-Kutta"
HERE = Path(__file__).parent
ROOT = HERE.parents[1]


@dataclass(frozen=True)
class Bar:
    """A ratio or a quantity, and what it has to be; no bound where it stands for comparison."""

    motion: str
    what: str
    value: float
    bound: float | None = None
    at_least: bool = False

    @property
    def verdict(self) -> str:
        """Whether it is what it has to be."""
        if self.bound is None:
            return ""
        return "holds" if (self.value >= self.bound if self.at_least else self.value <= self.bound) else "FAILS"


@dataclass(frozen=True)
class Ratios:
    """How times at equal tolerance compare.

    Attributes
    ----------
    to_heyoka : float
        The Taylor engine's to that of heyoka by hand, neither of which projects.
    projecting_to_heyoka : float
        The same where the Taylor engine projects.
    share, taylors_share : float
        What projection adds to the faster engine, and to the Taylor engine.
    """

    to_heyoka: float
    projecting_to_heyoka: float
    share: float
    taylors_share: float


def unprojected(engine: str) -> str:
    """Name of an engine that leaves drift alone."""
    return f"{engine}, drift: none"


def faster_engine(rows: Mapping[str, "Row"]) -> str:
    """Name of ours that takes less time, with projection."""
    return min(ENGINES, key=lambda name: rows[name].seconds)


def bars_of(motion: Motion, problem: MotionProblem, rows: Mapping[str, "Row"], ratios: Ratios) -> Iterator[Bar]:
    """The bars of one motion; ours is the faster engine, projecting, where no engine is named."""
    engine, name = faster_engine(rows), motion.name
    ours, by_hand = rows[engine].seconds, _best(rows, (HEYOKA, DOP853))
    yield Bar(name, "Taylor to heyoka by hand at equal tolerance, neither projects", ratios.to_heyoka, BY_HEYOKA)
    yield Bar(name, "Taylor with projection to heyoka by hand without", ratios.projecting_to_heyoka)
    yield Bar(name, f"time to heyoka by hand, ours {engine.split()[-1]}", ours / rows[HEYOKA].seconds, BY_HEYOKA)
    yield Bar(name, "time to the better by hand", ours / by_hand, BEST_BY_HAND)
    yield Bar(name, "times faster than SciPy's best solver", _best(rows, SOLVE_IVP) / ours, SCIPY_TIMES[name], True)
    yield Bar(name, "times faster than SciPy's older interfaces", _best(rows, tuple(OLDER_SCIPY)) / ours)
    yield Bar(name, "times faster than SUNDIALS' best", _best(rows, SUNDIALS) / ours, SUNDIALS_TIMES, True)
    yield Bar(name, "share that projection adds", ratios.share, PROJECTION_SHARE)
    yield Bar(name, "share that projection adds to Taylor", ratios.taylors_share)
    for kind, residual in _worst_residuals(motion, problem).items():
        yield Bar(name, f"{kind} residual at the end, of both engines", residual, RESIDUAL)
    first, theirs = _shortest([_ours_in_one_shot(motion), _sympy_in_one_shot(motion, problem)])
    yield Bar(name, "`holonom simulate` to SymPy and solve_ivp, whole processes", first / theirs, ONE_SHOT)
    yield Bar(name, "seconds of `holonom simulate`, whole process", first)
    yield Bar(name, "seconds that Maxima takes of it", _maxima_part(motion), MAXIMA_SECONDS.get(name))
    yield Bar(name, "seconds of SymPy and solve_ivp, whole process", theirs)


def general_bars(paper: Motion) -> Iterator[Bar]:
    """Many digits on the paper's example, and what `holonom --help` takes."""
    problem = motion_problem(paper.file, Request(paper.scene), Limits(), 80)
    true = find_reference(problem, [paper.until], int(OUR_DIGITS)).states[paper.until]
    ours = prepare_taylor(problem, paper.until, OUR_DIGITS, OUR_TOLERANCE, Stabilization.PROJECTION)
    seconds = shortest_times({0: python_batch(lambda _: ours.run(), ())})[0]
    begun = time.perf_counter()
    theirs = _odefun(problem, paper)
    yield Bar("paper", "times faster at 34 digits than mpmath.odefun at 30",
              (time.perf_counter() - begun) / seconds, MPMATH_TIMES, True)  # fmt: skip
    yield Bar("paper", "its error", relative_error(ours.state(ours.run()), true))
    yield Bar("paper", "mpmath.odefun's error", relative_error(theirs, true))
    help_, loading = _shortest([[_holonom(), "--help"], [sys.executable, "-c", "import holonom; holonom.load"]])
    yield Bar("", "seconds of `holonom --help`", help_, HELP)
    yield Bar("", "seconds of loading the package", loading, LOADING)


def _worst_residuals(motion: Motion, problem: MotionProblem) -> dict[str, float]:
    """The larger residuals of the constraints that the two engines leave."""
    requests = (
        SimulationRequest(tol=float(TOLERANCE), engine=engine, until=motion.until, samples=0)
        for engine in (EngineName.TAYLOR, EngineName.RUNGE_KUTTA)
    )
    found = [simulate(problem, request).report.residuals for request in requests]
    return {kind: max(residuals[kind] for residuals in found) for kind in ("position", "velocity")}


def _odefun(problem: MotionProblem, paper: Motion) -> State:
    with mpmath.workdps(MPMATH_DIGITS):
        start = [mpmath.mpf(problem.start[name]) for name in problem.state]
        return mpmath.odefun(paper_in_mpmath, 0, start)(mpmath.mpf(int(paper.until)))


def _best(rows: Mapping[str, "Row"], names: Sequence[str]) -> float:
    return min(rows[name].seconds for name in names if rows[name].seconds is not None)


def _ours_in_one_shot(motion: Motion) -> list[str]:
    settings = [text for name, value in motion.settings.items() for text in ("--set", f"{name}={value}")]
    scene = [str(motion.file), "--scene", motion.scene, *settings]
    return [_holonom(), "simulate", *scene, "--until", str(motion.until), "--tol", TOLERANCE, "--final", "--json", "-"]


def _maxima_part(motion: Motion) -> float:
    """Seconds until the motion program is there, as the command has it made: sandboxed, in two processes."""
    request = Request(motion.scene, settings=motion.settings)
    asked = request, Limits(), DOUBLE_DIGITS, open_names(request, DOUBLE_DIGITS)
    return min(_seconds_of(lambda: problem_document(motion.file, *asked)) for _ in range(ONE_SHOT_REPEATS))


def _sympy_in_one_shot(motion: Motion, problem: MotionProblem) -> list[str]:
    script = str(HERE / "simulation_sympy.py")
    start = map(repr, map(float, start_of(problem)))
    return [sys.executable, script, motion.name, str(float(motion.until)), TOLERANCE, *start]


def _holonom() -> str:
    return str(Path(sys.executable).with_name("holonom"))


def _shortest(commands: Sequence[Sequence[str]]) -> list[float]:
    """Seconds of whole processes, which take turns, after a first one: it makes an image of Maxima where there is none.

    It has Python keep the package's bytecode, too.

    The Taylor engine lets heyoka keep no compiled code: each run compiles anew.
    """
    _seconds(commands[0])
    rounds = [[_seconds(command) for command in commands] for _ in range(ONE_SHOT_REPEATS)]
    return [min(times) for times in zip(*rounds, strict=True)]


def _seconds(command: Sequence[str]) -> float:
    return _seconds_of(
        lambda: subprocess.run(command, cwd=ROOT, env=as_installed(), stdout=subprocess.DEVNULL, check=True)
    )


def _seconds_of(work: Callable[[], object]) -> float:
    begun = time.perf_counter()
    work()
    return time.perf_counter() - begun
