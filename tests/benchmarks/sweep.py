"""Sweeps against heyoka's batch integrator used by hand, each figure a ratio in one run.

    python tests/benchmarks/sweep.py DIRECTORY [SHARE]

writes sweep.txt there; SHARE, 1 without it, is how much of the million motions is run. Times of one core are those that
the process was given; where several cores are compared, those of the clock on the wall, for which the machine must be
quiet.
"""

import os
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from itertools import starmap
from pathlib import Path

import heyoka
import numpy as np

from holonom.cli import holonom
from holonom.confined import Limits
from holonom.program.motion_problem import motion_problem
from holonom.program.request import Request
from holonom.simulation.request import Stabilization
from holonom.sweeps.axes import read_axes
from holonom.sweeps.kept import read_kept
from holonom.sweeps.rows import Plan, RowMaker

ROOT = Path(__file__).parents[2]
CRANE, PAPER = ROOT / "examples" / "crane.mac", ROOT / "examples" / "paper" / "paper.mac"
GRID = ("m=50:500:100", "c=0:40:100")
MOTIONS, TOLERANCE = 10_000, 1e-12  # a chunk
DEPTHS, REPEATS = 4, 12
MILLION = 1_000_000


def by_hand() -> Callable[[], np.ndarray]:
    """The crane of examples/crane.mac, written down in heyoka, its masses and its brake runtime parameters."""
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
    lanes = heyoka.recommended_simd_size()
    integrator = heyoka.taylor_adaptive_batch(equations, np.zeros((6, lanes)), tol=TOLERANCE, pars=np.zeros((2, lanes)))
    start = np.array([[0.0], [0.0], [-3.0], [0.0], [0.0], [-0.3]])
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


def by_sweep(keep: str, drift: Stabilization) -> Callable[[], np.ndarray]:
    """The same rows by the rows of a sweep."""
    axes = read_axes(GRID, [], [], None, None)
    problem = motion_problem(CRANE, Request(), Limits(), open_parameters=axes.names)
    maker = RowMaker(Plan(problem, axes, read_kept([keep]), TOLERANCE, drift=drift))

    def run() -> np.ndarray:
        table = maker.table(0, MOTIONS)
        return np.array([table[name].to_numpy() for name in problem.state])

    return run


def seconds(*functions: Callable[[], object]) -> list[float]:
    """Least time that each was given on the processor, taken in turns, after what is compiled first.

    Where the stack happens to lie when compiled code is called, so that its vectors cross the lines of the cache or do
    not, decides about a fifth of its time: each function is called at several depths.
    """
    for function in functions:
        function()
    turns = [[_processor(_deeper(function, turn % DEPTHS)) for function in functions] for turn in range(REPEATS)]
    return [min(each) for each in zip(*turns, strict=True)]


def _deeper(function: Callable[[], object], depth: int) -> Callable[[], object]:
    """The same function, called from so many frames of C."""
    return function if depth == 0 else _deeper(lambda: list(starmap(function, [()])), depth - 1)


def _processor(function: Callable[[], object]) -> float:
    begun = time.process_time()
    function()
    return time.process_time() - begun


def rows_of_one_core() -> Iterator[str]:
    hand, plain = by_hand(), by_sweep("final", Stabilization.NONE)
    kept, looked = (
        by_sweep("final", Stabilization.PROJECTION),
        by_sweep("final,max(abs(lambda1))", Stabilization.PROJECTION),
    )
    apart = np.abs(hand() - plain()).max()
    base, *others = seconds(hand, plain, kept, looked)
    yield f"crane, {MOTIONS} motions, tolerance {TOLERANCE:g}, one core; final states agree to {apart:.0e}"
    yield f"  by hand                              {base / MOTIONS * 1e6:6.1f} us a motion"
    names = ("sweep without projection", "sweep with projection", "sweep with max(abs(lambda1))")
    for name, taken in zip(names, others, strict=True):
        yield f"  {name:36s} {taken / MOTIONS * 1e6:6.1f} us a motion, {taken / base:.2f} times"


def rows_of_radius() -> Iterator[str]:
    axes = read_axes(["u0=-2:2:2001"], [], [], None, None)
    problem = motion_problem(PAPER, Request("initial_motion_scene"), Limits(), open_parameters=axes.names)
    maker = RowMaker(Plan(problem, axes, read_kept(["radius"])))
    maker.table(0, 8)
    begun = time.process_time()
    table = maker.table(0, 2001)
    taken = time.process_time() - begun
    u0, radius = table["u0"].to_numpy(), table["radius"].to_numpy(zero_copy_only=False)
    missed = np.nanmax(np.abs(radius / np.sqrt(u0**2 + 0.5) - 1))
    yield f"radius over 2001 values of u0, once compiled: {taken:.2f} s on one core, relative errors up to {missed:.0e}"


def rows_of_workers(share: float) -> Iterator[str]:
    side = round((MILLION * share) ** 0.5)
    grid = ["--grid", f"m=50:500:{side}", "--grid", f"c=0:40:{side}"]
    taken = {}
    for workers in (1, 2):
        with tempfile.TemporaryDirectory() as folder:
            command = ["sweep", str(CRANE), *grid, "-o", f"{folder}/runs", "--workers", str(workers)]
            begun = time.perf_counter()
            holonom(command, standalone_mode=False)
            taken[workers] = time.perf_counter() - begun
    yield f"{side**2} crane motions with start-up, on {os.cpu_count()} cores: {taken[1]:.1f} s by this process alone, "
    yield f"  {taken[2]:.1f} s by two workers, {taken[1] / taken[2]:.2f} times as fast"


def main(directory: Path, share: float) -> None:
    lines = [*rows_of_one_core(), *rows_of_radius(), *rows_of_workers(share)]
    directory.mkdir(parents=True, exist_ok=True)
    (directory / "sweep.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main(Path(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else 1.0)
