"""The front door: a scene as one object that can be asked for all that Holonom finds.

What is asked for is computed when it is asked for, once; a scene does not change.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from decimal import Decimal
from enum import StrEnum
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from . import display  # noqa: F401  # results show their tables
from .equations import Equations
from .extras import naming_the_extra
from .failures import Failure, HolonomError
from .files import near_file, scene_file
from .program.forms import MotionProgram
from .program.motion_program import Solve
from .program.request import Request, read_settings
from .sandbox import Limits, warn_unconfined
from .simulation.derivations import Derivations
from .source import Source
from .temporary import KeptDirectory

if TYPE_CHECKING:
    from .crosscheck.report import CheckReport
    from .described import System
    from .description import Description
    from .free_motion import FreeMotion
    from .program.effects import MeasuredCosts
    from .program.motion_problem import MotionProblem
    from .program.right_hand_side import RightHandSide
    from .record import Record
    from .series.power_series import MotionSeries
    from .simulation.result import Simulation
    from .sweeps.run import Sweep
    from .typeset.notebook import Letter

Choice = TypeVar("Choice", bound=StrEnum)
Number = int | float | Fraction | Decimal | str
FEWEST_SAMPLES = 2  # the first instant and the last
LOADS_THE_LIBRARY = re.compile(r"\bload\s*\(.*?holonom")


def load(path: str | Path, scene: str | None = None, limits: Limits | None = None, **settings: Number) -> "Scene":
    """Open a scene file, or a description.

    Parameters
    ----------
    path : str or Path
        A Maxima file that describes one system and any number of scenes, or a description that `holonom describe`
        wrote; ``examples/...`` is found anywhere.
    scene : str or None
        The name that the scene is assigned to; None for the last one in the file.
    limits : Limits or None
        What each run of Maxima may take; None for two minutes and 4 GiB.
    **settings : int, float, Fraction, Decimal or str
        Numbers for what the file leaves open and for parameters; a float counts as the decimal that prints it.

    Raises
    ------
    HolonomError
        There is no such file; a setting is no number; a required sandbox is missing.

    Warns
    -----
    UserWarning
        This machine has no sandbox, and the limits do not trust the file.
    """
    file = scene_file(path)
    if not file.is_file():
        raise HolonomError(Failure.FILE_MISSING, file, near_file(file))
    return _opened(file, scene, settings, limits)


def system(text: str, scene: str | None = None, limits: Limits | None = None, **settings: Number) -> "Scene":
    """Open a scene that is given as Maxima text.

    Parameters
    ----------
    text : str
        What a scene file holds; ``load("holonom.mac")`` may be left out.
    scene, limits, **settings
        As for `load`.

    Raises
    ------
    HolonomError
        A setting is no number.
    """
    directory = KeptDirectory()
    file = directory.path / "system.mac"
    library = "" if LOADS_THE_LIBRARY.search(text) else 'load("holonom.mac")$ '
    file.write_text(library + text, encoding="utf-8")
    opened = _opened(file, scene, settings, limits)
    opened._directory = directory  # it is removed with the last scene that reads the file
    return opened


def _opened(file: Path, scene: str | None, settings: Mapping[str, Number], limits: Limits | None) -> "Scene":
    limits = limits or Limits()
    warn_unconfined(limits)
    return Scene(file, scene, _settings(settings), limits)


def sweep(
    scene: "Scene | str | Path",
    grid: Mapping[str, tuple[Number, Number, int]] | None = None,
    values: Mapping[str, Sequence[Number]] | None = None,
    sample: Mapping[str, str] | None = None,
    keep: Sequence[str] = ("final",),
    output: str | Path | None = None,
    size: int | None = None,
    seed: int | None = None,
    tol: float = 1e-12,
    until: Number | None = None,
    drift: str = "projection",
    solve: str = "direct",
    chunk: int = 10_000,
    workers: int = 1,
    scheduler: str | None = None,
) -> "Sweep":
    """Follow a motion for many values of its parameters.

    Parameters
    ----------
    scene : Scene, str or Path
        A scene, or the path of its file.
    grid : mapping of str to (first, last, count)
        Equidistant values.
    values : mapping of str to sequence
        These values.
    sample : mapping of str to str
        ``normal(MEAN,DEVIATION)``, ``uniform(LEAST,GREATEST)`` or ``loguniform(LEAST,GREATEST)``.
    keep : sequence of str
        As for ``holonom sweep --keep``.
    output : str, Path or None
        The folder of its files; None for one that is removed with the result.
    size, seed : int or None
        Of the sample.
    tol : float
        Tolerance of a step.
    until : number or None
        The last instant; None for the end of the scene's time span.
    drift : str
        ``projection`` or ``none``.
    solve : str
        ``direct`` or ``orthogonal``.
    chunk : int
        Rows of a file.
    workers : int
        Processes that compute. A program that asks for more than this one must guard its main part by
        ``if __name__ == "__main__"``, since each of them imports it.
    scheduler : str or None
        Address of a running Dask scheduler that is to be used instead.

    Returns
    -------
    Sweep
        ``sweep.dataset`` is lazy, ``sweep.to_pandas()`` all of it, ``sweep.plot()`` a map or a curve.

    Raises
    ------
    HolonomError
        The request cannot be met, or the folder holds something else.
    """
    from .simulation.request import Stabilization
    from .sweeps.axes import read_axes
    from .sweeps.kept import read_kept
    from .sweeps.run import SweepRequest, run_sweep

    opened = scene if isinstance(scene, Scene) else load(scene)
    grids = [f"{name}={first}:{last}:{count}" for name, (first, last, count) in (grid or {}).items()]
    lists = [f"{name}={','.join(map(str, numbers))}" for name, numbers in (values or {}).items()]
    samples = [f"{name}={text}" for name, text in (sample or {}).items()]
    axes = read_axes(grids, lists, samples, size, seed)
    cure = _choice(Stabilization, drift)
    wanted = SweepRequest(axes, read_kept(keep), tol, _instant(until), cure, chunk, workers, scheduler)
    directory = KeptDirectory() if output is None else None
    folder = directory.path if directory is not None else Path(output)
    found = run_sweep(opened._source, opened._request(solve), wanted, folder, opened.limits)
    return replace(found, _directory=directory)


class Scene:
    """A system put to work."""

    def __init__(self, file: Path, name: str | None, settings: Mapping[str, str], limits: Limits) -> None:
        self.file, self.settings, self.limits = file, dict(settings), limits
        self._name = name
        self._directory: KeptDirectory | None = None
        self._source = Source(file, limits)
        self._derived = Derivations(self._source)

    def with_settings(self, settings: Mapping[str, Number] | None = None, **more: Number) -> "Scene":
        """The same scene with other numbers for what the file leaves open and for parameters."""
        other = Scene(self.file, self._name, self.settings | _settings({**(settings or {}), **more}), self.limits)
        other._directory, other._source, other._derived = self._directory, self._source, self._derived
        return other

    # ---- the derivation ----

    @property
    def description(self) -> "Description":
        """All that the file says. It is run when the first question is put to it, once for each choice of settings."""
        return self._source.description(self.settings)

    @cached_property
    def record(self) -> "Record":
        """All that Maxima derives from the file."""
        from .record import derived_record

        return derived_record(self._source, self.settings, self.limits)

    @property
    def system(self) -> "System":
        """The system as it is described, before anything is derived."""
        return self.description.system

    @cached_property
    def equations(self) -> Equations:
        """The equations of the system with the scene's effects, (2) to (11), then those of its initial motion.

        Of a scene that prescribes reactions, those of the system as it is described.
        """
        record = self.record
        names = [scene.name for scene in record.scenes]
        wanted = self._name
        if wanted not in names:
            wanted = self._name_among([scene.name for scene in self.description.scenes])
        if wanted not in names:
            return Equations(record.derivations[0].equations)
        chosen = record.scenes[names.index(wanted)]
        return Equations((*record.derivations[chosen.derivation].equations, *chosen.equations))

    def _name_among(self, names: Sequence[str]) -> str | None:
        """The scene's name: the last one where none is given, None where there is no scene."""
        if self._name is not None and self._name not in names:
            said = f"{self._name}; the file has {', '.join(names) or 'none'}"
            raise HolonomError(Failure.NO_SUCH_SCENE, self.file, said)
        return self._name or next(reversed(names), None)

    @cached_property
    def symbols(self) -> Mapping[str, "Letter"]:
        """SymPy symbols of the equations, by name: ``scene.symbols["dot(q1)"]``."""
        from .typeset.notebook import letters

        described = self.record.system
        groups = ("coordinates", "velocities", "accelerations", "controls", "control_rates", "control_accelerations")
        names = [name for group in (*groups, "parameters", "multipliers") for name in getattr(described, group)]
        return letters([described.time, *names])

    def check(self) -> "CheckReport":
        """Compare every equation of the file with an independent SymPy evaluation."""
        from .crosscheck.check import check_record
        from .crosscheck.motions import motion_verdicts, read_motions
        from .crosscheck.questions import ask_for_check

        motions = read_motions(self.description, ask_for_check(self._source, self.settings))
        report = check_record(self.record, self.description)
        return report.with_verdicts(motion_verdicts(self.description, motions, report.seed))

    def free(self) -> "FreeMotion":
        """When the motion is free: as it is, under which laws always, under which for one trajectory."""
        from .free_motion import free_motion

        return free_motion(self._source, self._name, self.settings, self.limits)

    @naming_the_extra()
    def effects(self) -> "MeasuredCosts":
        """Which terms and effects there are, and what each costs in operations and in measured time."""
        from .program.effects import scene_costs

        return scene_costs(self._source, self._request("direct"), self.limits)

    # ---- the motion ----

    @naming_the_extra()
    def series(
        self,
        order: int = 20,
        digits: int | str = "automatic",
        precision: str | int | None = None,
        until: Number | None = None,
    ) -> "MotionSeries":
        """Expand the initial motion in power series.

        Parameters
        ----------
        order : int
            Highest power of t - t0.
        digits : int or str
            Confirmed significant digits; ``exact`` for rationals or nothing; ``automatic``: exact where possible.
        precision : str, int or None
            Compute with heyoka instead, in ``double``, ``extended``, ``quadruple`` or so many digits.
        until : number or None
            Instant to which the motion is continued by further expansions.

        Raises
        ------
        HolonomError
            The control law is not analytic at t0, G is singular there, or the digits cannot be had.
        """
        from .series.compute import compute_series
        from .series.power_series import SeriesRequest

        last = _instant(until)
        request = SeriesRequest(order, self._name, digits, last, self.settings, precision)
        return compute_series(self._source, request, self.limits)

    @naming_the_extra()
    def simulate(
        self,
        until: Number | None = None,
        samples: int | None = None,
        tol: float | None = None,
        precision: str | int = "double",
        engine: str = "auto",
        drift: str = "projection",
        solve: str = "direct",
        max_step: float | None = None,
        **parameters: Number,
    ) -> "Simulation":
        """Follow the motion in numbers.

        Parameters
        ----------
        until : number or None
            The last instant; None for the end of the scene's time span.
        samples : int or None
            So many equidistant instants; None for the engine's own steps.
        tol : float or None
            Tolerance of a step; None for what the precision holds.
        precision : str or int
            ``double``, ``extended``, ``quadruple`` or a number of digits.
        engine : str
            ``auto``, ``taylor``, ``runge-kutta`` or ``robust``.
        drift : str
            What keeps the constraints: ``projection``, ``baumgarte``, ``ggl`` or ``none``.
        solve : str
            ``direct`` or ``orthogonal``.
        max_step : float or None
            Time that no step is to exceed; None where the engine alone decides.
        **parameters : number
            Values in the place of the scene's; one that is named like an argument goes through `with_settings`. The
            next call with other values of the same ones derives and compiles nothing again.

        Returns
        -------
        Simulation
            ``motion["x"]`` is a series of samples, ``motion.to_pandas()`` all of them.

        Raises
        ------
        HolonomError
            The request cannot be met, or the motion cannot be followed so far.
        """
        if parameters:
            return self.with_settings(parameters).simulate(
                until, samples, tol, precision, engine, drift, solve, max_step
            )
        from .program.precision import read_precision
        from .simulation.request import EngineName, SimulationRequest, Stabilization
        from .simulation.simulate import simulate

        if samples is not None and samples < FEWEST_SAMPLES:
            raise HolonomError(Failure.TOO_FEW_SAMPLES, detail=str(samples))
        last = _instant(until)
        problem = self._problem(solve, read_precision(str(precision)).digits)
        follower, cure = _choice(EngineName, engine), _choice(Stabilization, drift)
        request = SimulationRequest(tol, str(precision), follower, cure, last, samples, max_step=max_step)
        return simulate(problem, request)

    @naming_the_extra()
    def rhs(self, solve: str = "direct") -> "RightHandSide":
        """The equations of motion as f(t, y) for any integrator, y the coordinates and then the velocities.

        The control law and the parameters are put in; nothing keeps the constraints but the accelerations.

        Raises
        ------
        HolonomError
            No order of pivots solves the equations of motion, as where constraints are redundant; the motion is not
            analytic everywhere.
        """
        from .program.motion_problem import DOUBLE_DIGITS
        from .program.right_hand_side import RightHandSide
        from .program.sign_pattern import with_values_in

        return RightHandSide(with_values_in(self._problem(solve, DOUBLE_DIGITS)))

    def program(self, solve: str = "direct") -> MotionProgram:
        """The motion program: accelerations and multipliers of (t, q, dot q, u, dot u, ddot u)."""
        return MotionProgram(self._source, self._request(solve), self.limits)

    def __repr__(self) -> str:
        scene = f", scene={self._name!r}" if self._name else ""
        settings = "".join(f", {name}={value}" for name, value in self.settings.items())
        return f"<Scene {str(self.file)!r}{scene}{settings}>"

    def _repr_html_(self) -> str | None:
        return self.equations._repr_html_()

    def _repr_latex_(self) -> str:
        return self.equations._repr_latex_()

    def _request(self, solve: str) -> Request:
        return Request(self._name, _choice(Solve, solve), self.settings)

    def _problem(self, solve: str, digits: int) -> "MotionProblem":
        return self._derived.motion(self._request(solve), digits)


def _instant(until: Number | None) -> Fraction | None:
    """An instant, exactly as it is written."""
    try:
        return None if until is None else Fraction(str(until))
    except (ValueError, ZeroDivisionError):
        raise HolonomError(Failure.NOT_AN_INSTANT, detail=str(until)) from None


def _choice(choices: type[Choice], text: str) -> Choice:
    """The member of an enumeration that is written so."""
    try:
        return choices(text)
    except ValueError:
        raise HolonomError(Failure.NOT_A_CHOICE, detail=f"{text}; there are {', '.join(choices)}") from None


def _settings(settings: Mapping[str, Number]) -> dict[str, str]:
    """Numbers in Maxima's notation."""
    texts = {name: repr(float(value)) if isinstance(value, float) else str(value) for name, value in settings.items()}
    return read_settings(f"{name}={text.replace('e+', 'e').replace('E+', 'e')}" for name, text in texts.items())
