"""Sweeps against heyoka's batch integrator used by hand, each figure a ratio in one run, beside the bar for it.

    python tests/benchmarks/sweep.py DIRECTORY [SHARE]

writes sweep.txt there; SHARE, 1 without it, is how much of the million motions is run. Times of one core are those that
the process was given; where several cores are compared, those of the clock on the wall, for which the machine must be
quiet. What a command does without its start-up is measured from when each worker has sent its first chunks, by the
times at which the files were written.
"""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cache, partial
from pathlib import Path
from statistics import median
from typing import NamedTuple

import heyoka
import numpy as np

from holonom.program.motion_problem import MotionProblem, motion_problem
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.simulation.engines.engine import advance
from holonom.simulation.hybrid_motion import HybridMotion
from holonom.simulation.initial_state import at_values
from holonom.simulation.request import EngineName, SimulationRequest, Stabilization
from holonom.simulation.simulate import _parametrized_problem
from holonom.sweeps.axes import read_axes
from holonom.sweeps.outputs import read_quantities
from holonom.sweeps.request import CHUNK
from holonom.sweeps.rows import Plan, RowMaker
from holonom.sweeps.stack import PLACES

ROOT = Path(__file__).parents[2]
CRANE, PAPER = ROOT / "examples" / "crane.mac", ROOT / "examples" / "paper" / "paper.mac"
GRID = ("m=50:500:100", "c=0:40:100")
MOTIONS, TOLERANCE = 10_000, 1e-12  # a chunk
REPEATS, TURNS = 12, 3
FIRST = 24  # chunks: those that two workers are given at once
MILLION = 1_000_000


def crane_by_hand(lanes: int) -> tuple[list, np.ndarray]:
    """The crane of examples/crane.mac, written down in heyoka, with its load and its brake open; and its start."""
    s, x, y, vs, vx, vy = heyoka.make_vars("s", "x", "y", "vs", "vx", "vy")
    t, m, c, mass = heyoka.time, heyoka.par[0], heyoka.par[1], 200.0
    u, du, ddu = 3.0 + 0.3 * heyoka.sin(t), 0.3 * heyoka.cos(t), -0.3 * heyoka.sin(t)
    dx, dvx = x - s, vx - vs
    free_s, free_y = (100.0 * heyoka.sin(t) - c * vs) / mass, -9.81
    curvature = 2.0 * (dvx**2 + vy**2 - du**2 - u * ddu)
    mobility = 4.0 * (dx**2 * (1.0 / m + 1.0 / mass) + y**2 / m)
    pull = -(curvature + 2.0 * y * free_y - 2.0 * dx * free_s) / mobility
    equations = [
        (s, vs), (x, vx), (y, vy),
        (vs, free_s - 2.0 * dx * pull / mass), (vx, 2.0 * dx * pull / m), (vy, free_y + 2.0 * y * pull / m),
    ]  # fmt: skip
    return equations, np.repeat(np.array([[0.0], [0.0], [-3.0], [0.0], [0.0], [-0.3]]), lanes, axis=1)


def by_hand() -> Callable[[], np.ndarray]:
    """heyoka's batch integrator, as its manual shows it."""
    lanes = heyoka.recommended_simd_size()
    equations, start = crane_by_hand(lanes)
    integrator = heyoka.taylor_adaptive_batch(equations, start, tol=TOLERANCE, pars=np.zeros((2, lanes)))
    values = read_axes(GRID, [], [], None, None).numbers(0, MOTIONS)

    def run() -> np.ndarray:
        found = np.empty((6, MOTIONS))
        for first in range(0, MOTIONS, lanes):
            here = slice(first, first + lanes)
            integrator.set_time(0.0)
            integrator.state[:] = start
            integrator.pars[:] = values[:, here]
            integrator.propagate_until(10.0)
            found[:, here] = integrator.state
        return found

    return run


@cache
def crane(open_parameters: tuple[str, ...]) -> MotionProblem:
    """Its motion, as Maxima derives it."""
    return motion_problem(CRANE, Request(), Limits(), open_parameters=open_parameters)


def by_sweep(keep: str, stabilization: Stabilization) -> Callable[[], np.ndarray]:
    """The same rows by the rows of a sweep."""
    axes = read_axes(GRID, [], [], None, None)
    problem = crane(axes.names)
    maker = RowMaker(Plan(problem, axes, read_quantities([keep]), TOLERANCE, stabilization=stabilization))

    def run() -> np.ndarray:
        table = maker.table(0, MOTIONS)
        return np.array([table[name].to_numpy() for name in problem.state])

    return run


def seconds(*functions: Callable[[], object]) -> list[float]:
    """Least time that each was given on the processor, taken in turns, after what is compiled first.

    Each function is called at both places, because the place of the stack decides about a quarter of its time.
    """
    for function in functions:
        function()
    turns = [
        [_processor(partial(PLACES[turn % len(PLACES)], partial(function))) for function in functions]
        for turn in range(REPEATS)
    ]
    return [min(each) for each in zip(*turns, strict=True)]


def _processor(function: Callable[[], object]) -> float:
    begun = time.process_time()
    function()
    return time.process_time() - begun


def bar(name: str, found: float, least: float | None = None, most: float | None = None, unit: str = "") -> str:
    """A figure beside its bar, and whether it keeps it."""
    kept = found >= least if least is not None else found <= most
    asked = f"at least {least:g}" if least is not None else f"at most {most:g}"
    return f"  {name:44s} {found:8.2f}{unit}, {asked}: {'kept' if kept else 'MISSED'}"


def rows_of_one_core() -> Iterator[str]:
    hand, plain = by_hand(), by_sweep("final", Stabilization.NONE)
    kept = by_sweep("final", Stabilization.PROJECTION)
    looked = by_sweep("final,max(abs(lambda1))", Stabilization.PROJECTION)
    apart = np.abs(hand() - plain()).max()
    base, *others = seconds(hand, plain, kept, looked)
    yield f"crane, {MOTIONS} motions, tolerance {TOLERANCE:g}, one core; final states agree to {apart:.0e}"
    yield f"  by hand {base / MOTIONS * 1e6:.1f} us a motion; the sweep, in terms of that:"
    yield bar("without projection", others[0] / base, most=1.3)
    yield bar("with projection", others[1] / base, most=1.6)
    yield f"  with max(abs(lambda1)), too                  {others[2] / base:8.2f}"
    yield from rows_of_other_engines(base / MOTIONS)


def rows_of_other_engines(base: float) -> Iterator[str]:
    """What motions take that are followed one by one, by the engine's steps alone, and in an ensemble of batches."""
    problem = at_values(crane(("m", "c")), {"m": Fraction(100), "c": Fraction(10)})
    for engine in (EngineName.TAYLOR, EngineName.RUNGE_KUTTA):
        request = SimulationRequest(engine=engine, tol=TOLERANCE, stabilization=Stabilization.NONE)
        taken = min(engine_seconds(problem, request) for _ in range(REPEATS))
        yield f"  one by one, {engine:32s} {taken / base:8.2f}"
    yield f"  heyoka's ensemble of batches                 {ensemble() / base:8.2f}"


def engine_seconds(problem: MotionProblem, request: SimulationRequest) -> float:
    motion = HybridMotion(_parametrized_problem(problem, request), request, 10.0)
    return _processor(lambda: advance(motion.mode.engine, 10.0))


def ensemble() -> float:
    """Seconds a motion, with 16 lanes a batch; times of all threads."""
    lanes, batches = 16, 64
    integrator = heyoka.taylor_adaptive_batch(*crane_by_hand(lanes), tol=TOLERANCE, pars=np.zeros((2, lanes)))
    values = read_axes(GRID, [], [], None, None).numbers(0, lanes * batches)

    def begin(integrator: heyoka.taylor_adaptive_batch, place: int) -> heyoka.taylor_adaptive_batch:
        integrator.pars[:] = values[:, place * lanes : (place + 1) * lanes]
        return integrator

    def run() -> None:
        heyoka.ensemble_propagate_until_batch(integrator, 10.0, batches, begin)

    return seconds(run)[0] / (lanes * batches)


def rows_of_radius() -> Iterator[str]:
    axes = read_axes(["u0=-2:2:2001"], [], [], None, None)
    problem = motion_problem(PAPER, Request("initial_motion_scene"), Limits(), open_parameters=axes.names)
    maker = RowMaker(Plan(problem, axes, read_quantities(["radius"])))
    maker.table(0, 8)
    taken = min(_processor(lambda: maker.table(0, 2001)) for _ in range(3))
    table = maker.table(0, 2001)
    u0, radius = table["u0"].to_numpy(), table["radius"].to_numpy(zero_copy_only=False)
    missed = np.nanmax(np.abs(radius / np.sqrt(u0**2 + 0.5) - 1))
    yield f"radius over 2001 values of u0, once compiled, on one core; relative errors up to {missed:.0e}"
    yield bar("time", taken, most=2, unit=" s")


class Run(NamedTuple):
    """A command that has run."""

    rows: int
    seconds: float
    written: tuple[float, ...]  # when each file was
    megabytes: float

    @property
    def rate(self) -> float:
        """Rows a second, between the first chunks and the last, which may be a short one."""
        times = self.written[FIRST:-1]
        return CHUNK * (len(times) - 1) / (times[-1] - times[0])


def command(rows: float, workers: int) -> Run:
    """The command from its start to its end, with at most some rows."""
    side = round(rows**0.5)
    grid = ["--grid", f"m=50:500:{side}", "--grid", f"c=0:40:{side}"]
    with tempfile.TemporaryDirectory() as folder:
        asked = [sys.executable, "-m", "holonom", "sweep", str(CRANE), *grid, "-o", f"{folder}/runs"]
        begun = time.perf_counter()
        process = subprocess.Popen([*asked, "--workers", str(workers)], stdout=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        taken = time.perf_counter() - begun
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            raise RuntimeError(f"the sweep ended with {process.returncode}")
        written = sorted(part.stat().st_mtime for part in Path(folder, "runs").glob("*.parquet"))
    return Run(side**2, taken, tuple(written), usage.ru_maxrss / 1024)


def rows_of_commands(share: float) -> Iterator[str]:
    million = MILLION * share
    small = [command(million * part, 1) for part in (0.1, 0.2)]
    turns = [(command(million, 1), command(million, 2)) for _ in range(TURNS)]
    (one, two), many = ([median(run.seconds for run in runs) for runs in zip(*turns, strict=True)], turns[0][0])
    by = f"by the command, on {os.cpu_count()} cores; with start-up; medians of {TURNS} turns"
    yield f"{many.rows} crane motions {by}"
    yield f"  by this process alone {one:.1f} s, by two workers {two:.1f} s"
    yield bar("two workers, with start-up", two, most=30, unit=" s")
    if len(many.written) > 2 * FIRST:
        alone, both = (median(run.rate for run in runs) for runs in zip(*turns, strict=True))
        yield bar("two workers against one, without start-up", both / alone, least=1.8)
    yield f"  two workers against one, with start-up       {one / two:8.2f}"
    sizes = ", ".join(f"{run.megabytes:.0f} MiB for {run.rows}" for run in (*small, many))
    yield f"  largest memory by this process alone: {sizes} motions"
    yield bar("the last in terms of the one before", many.megabytes / small[1].megabytes, most=1.1)


def main(directory: Path, share: float) -> None:
    lines = [*rows_of_one_core(), *rows_of_radius(), *rows_of_commands(share)]
    directory.mkdir(parents=True, exist_ok=True)
    (directory / "sweep.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main(Path(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else 1.0)
