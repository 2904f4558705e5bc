"""The commands about one motion: as a power series, and numerically."""

import sys
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..failures import HolonomError
from ..options import options_of
from ..program.request import Request
from ..sandbox import Limits
from ..series.request import AUTOMATIC, EXACT, SeriesRequest
from ..simulation.request import FINAL_STATE_ALONE, SimulationRequest
from .background import run_in_background
from .group import OWN_PROCESS, holonom
from .options import (
    FAILED,
    IntegerRange,
    as_time,
    asks_one_scene,
    json_text,
    present,
    publish,
    runs_scenes,
    takes,
    writes_json,
)
from .outputs import STANDARD_OUTPUT, OutputFile

if TYPE_CHECKING:
    from ..program.motion_problem import MotionProblem
    from ..simulation.result import Report, Simulation


@holonom.command(
    examples=[
        "series examples/pendulum.mac --order 40",
        "series examples/paper/paper.mac --order 8 --exact --at 1/10",
        "series examples/paper/paper.mac --order 3 --sensitivity u0,q1",
    ]
)
@asks_one_scene()
@takes(*options_of(SeriesRequest, "order", "precision", "until", "sensitivities"))
@click.option("--exact", is_flag=True, help="Use rational coefficients only. Default: exact if possible.")
@click.option("--digits", metavar="D", type=IntegerRange(min=1), help="Significant digits of the coefficients.")
@click.option("--at", metavar="T", callback=as_time, help="Also evaluate the series at time T.")
@writes_json
@runs_scenes
def series(
    scene_file: Path,
    request: Request,
    options: dict[str, Any],
    exact: bool,
    digits: int | None,
    at: Fraction | None,
    json_file: Path | None,
    limits: Limits,
) -> int:
    """Expand the initial motion in power series.

    The report states the radius of convergence.
    """
    from ..display.motion import show_series
    from ..series.compute import compute_series
    from ..series.power_series import series_document, values_at

    if sum([exact, digits is not None, options["precision"] is not None]) > 1:
        raise click.UsageError("--exact, --digits and --precision exclude each other")
    wanted = EXACT if exact else digits or AUTOMATIC
    asked = SeriesRequest(scene=request.scene, digits=wanted, settings=request.settings, **options)
    motion = compute_series(scene_file, asked, limits)
    values = None if at is None else values_at(motion, at)
    present(series_document(motion, values), json_file, show_series, motion, values)
    return 0


SAMPLES_OF_A_PLOT = 1001


@holonom.command(
    examples=[
        "simulate examples/pendulum.mac --until 10 --plot swing.svg",
        "simulate examples/pendulum.mac --precision 50 -o swing.csv",
    ]
)
@asks_one_scene(*options_of(Request, "solve"))
@takes(*options_of(SimulationRequest))
@click.option("--equilibrium", metavar="NAME", help="Start at rest in an equilibrium, in place of the scene's start.")
@click.option("--final", is_flag=True, help="Write only the final state to the JSON document.")
@writes_json
@click.option(
    "-o",
    "--output",
    metavar="FILE.csv|.npz|.parquet",
    type=OutputFile(),
    help="Write the samples of the motion.",
)
@click.option("--plot", "plot_file", metavar="FILE.svg|.png", type=OutputFile(), help="Plot the motion.")
@click.option("--curves", metavar="NAME,...", help="Curves of the plot, such as x,dot(x),energy. Default: all.")
@click.option(
    "--film",
    "film_file",
    metavar="FILE.svg|.html|.gif|.mp4",
    type=OutputFile(),
    help="Write a film of the system.",
)
@runs_scenes
def simulate(
    scene_file: Path,
    request: Request,
    options: dict[str, Any],
    equilibrium: str | None,
    final: bool,
    json_file: Path | None,
    output: Path | None,
    plot_file: Path | None,
    curves: str | None,
    film_file: Path | None,
    limits: Limits,
) -> int:
    """Integrate the equations of motion.

    The report states the accuracy. Functions of time are scanned first, so that no step misses a pulse longer than
    1/32768 of the time span. The exit status is 1 if errors of the constraints, the energy or forces are too large for
    the tolerance.
    """
    if curves is not None and plot_file is None:
        raise click.UsageError("--curves chooses those of --plot")
    files = _Files(json_file, final, output, plot_file, None if curves is None else _names_of(curves), film_file)
    wanted = SimulationRequest(**options)
    problem = _derived(scene_file, request, wanted, equilibrium, limits)
    from ..simulation.output import require_formats

    require_formats(output, plot_file, film_file)
    report, simulation = _integrated(problem, files.sampled(wanted), files, limits)
    _present(problem, report, simulation, files)
    return 0 if report.trusted else FAILED


@dataclass(frozen=True)
class _Files:
    """The files that a motion is written to."""

    json: Path | None
    final: bool  # the JSON document is of the final state alone
    samples: Path | None
    plot: Path | None
    curves: list[str] | None  # of the plot; None for all
    film: Path | None

    @property
    def drawn(self) -> bool:
        """True if there is a picture of the motion."""
        return self.plot is not None or self.film is not None

    @property
    def streamed(self) -> bool:
        """True if samples are written as they are computed, and not stored."""
        from ..simulation.output import streams

        alone = not self.drawn and (self.json is None or self.final)
        return alone and self.samples is not None and streams(self.samples)

    def sampled(self, wanted: SimulationRequest) -> SimulationRequest:
        """Return the request with as many samples as the files need."""
        if self.final and self.samples is None and not self.drawn:
            return replace(wanted, samples=FINAL_STATE_ALONE)
        return replace(wanted, samples=SAMPLES_OF_A_PLOT) if wanted.samples is None and self.drawn else wanted


def _derived(
    scene_file: Path, request: Request, wanted: SimulationRequest, equilibrium: str | None, limits: Limits
) -> "MotionProblem":
    """Derive the motion. Modules that integrate it are imported at the same time."""
    from ..program.motion_problem import motion_problem, problem_document, read_problem
    from ..simulation.derivations import open_names, stands
    from ..source import Source

    source, digits = Source(scene_file, limits), _digits_of(wanted.precision)
    request = replace(request, derivatives=bool(wanted.sensitivities))
    if equilibrium is not None:
        from ..scene import Scene
        from ..stability.start import started_at_equilibrium

        found = Scene(scene_file, request.scene, request.settings, limits).equilibria()
        source = started_at_equilibrium(source, found, equilibrium)
    imports = partial(_import_readers, click.get_current_context().obj is OWN_PROCESS)
    with run_in_background(scene_file, limits, imports):
        document = problem_document(source, request, limits, digits, open_names(request, digits, wanted.sensitivities))
    problem = read_problem(document, source.description(request.settings))
    return problem if stands(problem) else motion_problem(source, request, limits, digits)


def _integrated(
    problem: "MotionProblem", wanted: SimulationRequest, files: _Files, limits: Limits
) -> "tuple[Report, Simulation | None]":
    """Integrate the motion and write its files. Streamed samples are not returned."""
    from ..display.progress import motion_progress
    from ..simulation.output import require_disk, require_memory, sample_file, write_files
    from ..simulation.simulate import integrate
    from ..simulation.simulate import simulate as integrate_and_store

    if files.streamed:
        require_disk(problem, wanted.samples or 0, files.samples)
        with (
            motion_progress(problem.title) as progress,
            sample_file(files.samples, _digits_of(wanted.precision)) as take,
        ):
            return integrate(problem, wanted, take, progress), None
    require_memory(problem, wanted.samples or 0, limits.memory_mib)
    with motion_progress(problem.title) as progress:
        simulation = integrate_and_store(problem, wanted, progress)
    write_files(simulation, files.samples, files.plot, files.curves, files.film)
    return simulation.report, simulation


def _present(problem: "MotionProblem", report: "Report", simulation: "Simulation | None", files: _Files) -> None:
    """Write the JSON document, the table and the reasons of a failed accuracy check."""
    from ..display.motion import rejection, show_report
    from ..simulation.output import report_document, simulation_document

    if files.json is not None:
        final = files.final or simulation is None
        publish(json_text(report_document(report) if final else simulation_document(simulation)), files.json)
    if files.json != STANDARD_OUTPUT:
        from .console import make_console

        show_report(make_console(), problem.scene, problem.title, report)
    for violation in report.violations:
        click.echo(rejection(violation), err=True)


def _names_of(curves: str) -> list[str]:
    from ..sweeps.outputs import items_of

    return [name.strip() for name in items_of(curves)]


def _digits_of(precision: str) -> int:
    """Return the number of decimal digits of the initial state."""
    from ..program.motion_problem import DOUBLE_DIGITS

    if precision == "double":
        return DOUBLE_DIGITS  # without waiting for heyoka
    from ..program.precision import read_precision

    return read_precision(precision).digits


def _import_readers(own_process: bool) -> None:
    """Import the modules needed next."""
    with suppress(ImportError, HolonomError):  # missing modules are reported when they are needed
        import jsonschema_rs  # noqa: F401

        if own_process:
            _import_heyoka_alone()

        from ..display import motion, progress  # noqa: F401
        from ..simulation import output, simulate  # noqa: F401
        from ..simulation.engines import runge_kutta, taylor  # noqa: F401
        from . import console  # noqa: F401


def _import_heyoka_alone() -> None:
    """Import heyoka without SymPy, which takes four times as long to import.

    A simulation does not need SymPy. heyoka remembers that it found none, so this is only for a process in which no
    other code uses it.
    """
    if "sympy" not in sys.modules:
        sys.modules["sympy"] = None
        try:
            import heyoka  # noqa: F401
        finally:
            del sys.modules["sympy"]
