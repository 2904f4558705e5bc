"""High-level API: a scene as one object with all results of Holonom.

Each result is computed once, at its first use. A scene does not change.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import display  # noqa: F401  # results show their tables
from .equations import Equations
from .extras import naming_the_extra
from .failures import ErrorKind, HolonomError
from .files import near_file, scene_file
from .language import translatable
from .options import Number, options_of, takes_options
from .program.forms import MotionProgram
from .program.request import DaeRequest, FreeRequest, Request, Solve, read_settings
from .sandbox import Limits, warn_unsandboxed
from .series.request import SeriesRequest
from .simulation.derivations import Derivations
from .simulation.request import SimulationRequest
from .source import Source
from .stability.request import AlongRequest, EquilibriaRequest, LinearizationRequest
from .sweeps.request import SweepRequest
from .temporary import OwnDirectory

if TYPE_CHECKING:
    from .crosscheck.report import CheckReport
    from .dae import Dae
    from .described import System
    from .description import Description
    from .free_motion import FreeMotion
    from .program.effects import MeasuredCosts
    from .program.motion_problem import MotionProblem
    from .program.right_hand_side import RightHandSide
    from .record import Record
    from .series.power_series import MotionSeries
    from .simulation.result import Simulation
    from .stability.along import LinearizedMotion
    from .stability.branches import Branches
    from .stability.equilibria import Equilibria
    from .stability.linear_equations import LinearEquations
    from .stability.linearization import Linearization
    from .sweeps.run import Sweep
    from .typeset.notebook import TypesetSymbol

LOADS_THE_LIBRARY = re.compile(r"\bload\s*\(.*?holonom")


def load(path: str | Path, scene: str | None = None, limits: Limits | None = None, **settings: Number) -> "Scene":
    """Open a scene file, or a description.

    Parameters
    ----------
    path : str or Path
        A Maxima file that describes one system and any number of scenes, or a description that `holonom describe`
        wrote. ``examples/...`` is found from any folder.
    scene : str or None
        Name of the scene. Default: the last one in the file.
    limits : Limits or None
        Limits of each run of Maxima. Default: 120 s and 4 GiB.
    **settings : int, float, Fraction, Decimal or str
        Values of parameters, and of variables of the file. A float counts as the decimal that prints it.
        ``closed_form_size`` is the size of the largest closed form, in terms.

    Returns
    -------
    Scene
        The scene. The file runs at the first use of a result.

    Raises
    ------
    HolonomError
        If the file does not exist, a setting is not a number, or a required sandbox is missing.

    Warns
    -----
    UserWarning
        If this machine has no sandbox, and the limits do not trust the file.

    Examples
    --------
    >>> import holonom
    >>> holonom.load("examples/pendulum.mac", m=2).settings
    {'m': '2'}
    """
    file = scene_file(path)
    if not file.is_file():
        raise HolonomError(ErrorKind.FILE_MISSING, file, near_file(file))
    return _opened(file, scene, settings, limits)


def system(text: str, scene: str | None = None, limits: Limits | None = None, **settings: Number) -> "Scene":
    """Open a scene that is given as Maxima text.

    Parameters
    ----------
    text : str
        Text of a scene file, also without ``load("holonom.mac")``.
    scene, limits
        As for `load`.
    **settings : int, float, Fraction, Decimal or str
        As for `load`.

    Returns
    -------
    Scene
        The scene. The file runs at the first use of a result.

    Raises
    ------
    HolonomError
        If a setting is not a number.

    Examples
    --------
    >>> import holonom
    >>> text = "system : holonomic_system(coordinates = [x], kinetic_energy = m*dot(x)^2/2, parameters = [m])$"
    >>> one = holonom.system(text)
    >>> one.system.coordinates
    ('x',)
    """
    directory = OwnDirectory()
    file = directory.path / "system.mac"
    library = "" if LOADS_THE_LIBRARY.search(text) else 'load("holonom.mac")$ '
    file.write_text(library + text, encoding="utf-8")
    return _opened(file, scene, settings, limits, directory)


def _opened(
    file: Path,
    scene: str | None,
    settings: Mapping[str, Number],
    limits: Limits | None,
    directory: OwnDirectory | None = None,
) -> "Scene":
    limits = limits or Limits()
    warn_unsandboxed(limits)
    source = Source(file.absolute(), limits, directory)  # the working directory may change
    return Scene(file, scene, _settings(settings), limits, source)


@takes_options(
    *options_of(SweepRequest, "tol", "until", "stabilization"),
    *options_of(Request, "solve"),
    *options_of(SweepRequest, "chunk", "workers", "scheduler"),
)
def sweep(
    scene: "Scene | str | Path",
    grid: Mapping[str, tuple[Number, Number, int]] | None = None,
    values: Mapping[str, Sequence[Number]] | None = None,
    sample: Mapping[str, str] | None = None,
    keep: Sequence[str] | str = ("final",),
    output: str | Path | None = None,
    size: int | None = None,
    seed: int | None = None,
    *,
    options: dict[str, Any],
) -> "Sweep":
    """Integrate a motion for many values of its parameters.

    Parameters
    ----------
    scene : Scene, str or Path
        A scene, or the path of its file.
    grid : mapping of str to (first, last, count)
        Equally spaced values.
    values : mapping of str to sequence
        Lists of values.
    sample : mapping of str to str
        Distributions: ``normal(MEAN,DEVIATION)``, ``uniform(MIN,MAX)`` or ``loguniform(MIN,MAX)``.
    keep : str or sequence of str
        Outputs, such as ``final``, ``max(x)``, ``at(x,2)``, as for ``holonom sweep --keep``.
    output : str, Path or None
        Folder of the results. Default: a temporary one, removed with the result.
    size, seed : int or None
        Size of the sample, and seed of its random numbers.
    {options}

    Returns
    -------
    Sweep
        Lazy rows ``sweep.dataset``, all rows ``sweep.to_pandas()``, and a map or a curve ``sweep.plot()``.

    Raises
    ------
    HolonomError
        If the request cannot be met, or the folder contains something else.

    Notes
    -----
    A program that uses more than one process must guard its main part by ``if __name__ == "__main__"``, because each
    process imports it.

    Examples
    --------
    >>> import holonom
    >>> found = holonom.sweep("examples/crane.mac", values={"m": [100, 200]}, keep=["max(abs(lambda1))"], until=1)
    >>> found.statuses
    {'ok': 2}
    """
    from .sweeps.axes import axes_of
    from .sweeps.outputs import read_quantities
    from .sweeps.run import run_sweep

    opened = scene if isinstance(scene, Scene) else load(scene)
    axes = axes_of(grid, values, sample, size, seed)
    request = opened._request(options.pop("solve"))
    outputs = read_quantities([keep] if isinstance(keep, str) else keep)
    wanted = SweepRequest(axes, outputs, called=str(opened.file), **options)
    directory = OwnDirectory() if output is None else None
    folder = directory.path if directory is not None else Path(output)
    found = run_sweep(opened._source, request, wanted, folder, opened.limits)
    return replace(found, _directory=directory)


class Scene:
    """A system with control law, parameter values and initial state, from a file.

    Results are computed at first use and stored. A scene does not change. In the examples of the methods `scene` is
    ``holonom.load("examples/pendulum.mac")``.

    Examples
    --------
    >>> import holonom
    >>> holonom.load("examples/pendulum.mac")
    <Scene 'examples/pendulum.mac'>
    """

    def __init__(
        self, file: Path, name: str | None, settings: Mapping[str, str], limits: Limits, source: Source | None = None
    ) -> None:
        self.file, self._settings, self.limits = file, dict(settings), limits
        self._name = name
        self._source = source or Source(file, limits)
        self._derived = Derivations(self._source)

    @property
    def settings(self) -> dict[str, str]:
        """Settings that the scene was opened with, a copy.

        Examples
        --------
        >>> scene.settings
        {}
        """
        return dict(self._settings)

    def with_settings(self, settings: Mapping[str, Number] | None = None, **more: Number) -> "Scene":
        """Return the scene with other parameter values.

        Parameters
        ----------
        settings : mapping of str to number or None
            Values of parameters, and of variables of the file.
        **more : number
            Values by name, which take precedence over `settings`.

        Returns
        -------
        Scene
            A new scene.

        Raises
        ------
        HolonomError
            If a setting is not a number.

        Examples
        --------
        >>> scene.with_settings(m=2).settings
        {'m': '2'}
        """
        chosen = self._settings | _settings({**(settings or {}), **more})
        other = Scene(self.file, self._name, chosen, self.limits, self._source)
        other._derived = self._derived
        return other

    # ---- the derivation ----

    @property
    def description(self) -> "Description":
        """Description in the file, which runs once for each choice of settings.

        Examples
        --------
        >>> [each.name for each in scene.description.scenes]
        ['lengthening_scene', 'swing_scene']
        """
        return self._source.description(self.settings)

    @cached_property
    def record(self) -> "Record":
        """Derivation record: all equations that Maxima derives from the file.

        Examples
        --------
        >>> scene.record.system.multipliers
        ('lambda1',)
        """
        from .record import derived_record

        return derived_record(self._source, self.settings, self.limits)

    @property
    def system(self) -> "System":
        """System as described, before the derivation.

        Examples
        --------
        >>> scene.system.coordinates
        ('x', 'y')
        """
        return self.description.system

    @cached_property
    def equations(self) -> Equations:
        """Equations (2) to (11) with the scene's effects, and of the initial motion.

        For a scene that prescribes reactions, these are the equations of the system as described.

        Examples
        --------
        >>> scene.equations["8"][0].name
        'equations for the multipliers'
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
        """Return the scene's name, by default the last one, or None."""
        if self._name is not None and self._name not in names:
            listed = ", ".join(names) or translatable("none")
            detail = translatable("%(name)s; the file has %(names)s", name=self._name, names=listed)
            raise HolonomError(ErrorKind.NO_SUCH_SCENE, self.file, detail)
        return self._name or next(reversed(names), None)

    @cached_property
    def symbols(self) -> Mapping[str, "TypesetSymbol"]:
        """SymPy symbols of the equations, by name.

        Examples
        --------
        >>> scene.symbols["x"]
        x
        """
        from .typeset.notebook import TypesetSymbol

        described = self.record.system
        groups = ("coordinates", "velocities", "accelerations", "controls", "control_rates", "control_accelerations")
        names = [name for group in (*groups, "parameters", "multipliers") for name in getattr(described, group)]
        return {name: TypesetSymbol(name) for name in (described.time, *names)}

    def check(self) -> "CheckReport":
        """Compare every equation of the file with an independent SymPy evaluation.

        Returns
        -------
        CheckReport
            A verdict for each equation, and for the programs of motions.

        Raises
        ------
        HolonomError
            If the file cannot be derived.

        Examples
        --------
        >>> scene.check().disagreements
        0
        """
        from .crosscheck.check import check_record
        from .crosscheck.motions import motion_verdicts, read_motions
        from .crosscheck.questions import ask_for_check

        motions = read_motions(self.description, ask_for_check(self._source, self.settings))
        report = check_record(self.record, self.description)
        return report.with_verdicts(motion_verdicts(self.description, motions, report.seed))

    @takes_options(*options_of(FreeRequest))
    def free(self, options: dict[str, Any]) -> "FreeMotion":
        """Find whether the motion is free, and the control laws under which it is.

        Parameters
        ----------
        {options}

        Returns
        -------
        FreeMotion
            Verdicts on this motion, on laws for every motion and on laws for one trajectory.

        Raises
        ------
        HolonomError
            If the file cannot be derived.

        Examples
        --------
        >>> print(scene.free().motion.verdict)
        not free
        """
        from .free_motion import free_motion

        return free_motion(self._source, self._name, self.settings, self.limits, **options)

    @naming_the_extra()
    def effects(self) -> "MeasuredCosts":
        """Measure the cost of each term and effect.

        Returns
        -------
        MeasuredCosts
            Terms and effects with their operations and seconds.

        Raises
        ------
        HolonomError
            If the file cannot be derived.

        Examples
        --------
        >>> len(scene.effects().terms)
        17
        """
        from .program.effects import scene_costs

        return scene_costs(self._source, self._request(), self.limits)

    # ---- the motion ----

    @naming_the_extra()
    @takes_options(*options_of(SeriesRequest))
    def series(self, options: dict[str, Any]) -> "MotionSeries":
        """Expand the initial motion in power series.

        Parameters
        ----------
        {options}

        Returns
        -------
        MotionSeries
            Coefficients of the coordinates, velocities and multipliers, and the radius of convergence.

        Raises
        ------
        HolonomError
            If the control law is not analytic at t0, G is singular there, or the digits cannot be reached.

        Examples
        --------
        >>> scene.series(order=4).coordinates["x"][1]
        '0'
        """
        from .series.compute import compute_series

        request = SeriesRequest(scene=self._name, settings=self.settings, **options)
        return compute_series(self._source, request, self.limits)

    @naming_the_extra()
    @takes_options(*options_of(SimulationRequest), *options_of(Request, "solve"))
    def simulate(self, options: dict[str, Any], **parameters: Number) -> "Simulation":
        """Integrate the motion numerically.

        Parameters
        ----------
        {options}
        **parameters : number
            Values of parameters, in place of the scene's. Use `with_settings` for a parameter with the name of an
            argument. Calls with other values of the same parameters derive and compile nothing again.

        Returns
        -------
        Simulation
            Samples ``motion["x"]``, derivatives ``motion["d(x, m)"]`` with ``sensitivities=["m"]``, and
            ``motion.to_pandas()``.

        Raises
        ------
        HolonomError
            If the request cannot be met, or the motion cannot be continued so far.

        Examples
        --------
        >>> motion = scene.simulate(until=1, samples=3)
        >>> motion["x"].shape, motion.report.trusted
        ((3,), True)
        """
        if parameters:
            return self.with_settings(parameters).simulate(**options)
        from .program.precision import read_precision
        from .simulation.output import BYTES_IN_ARRAYS, require_memory
        from .simulation.simulate import simulate

        solve = options.pop("solve")
        request = SimulationRequest(**options)
        digits = read_precision(str(request.precision)).digits
        problem = self._derived.motion(self._request(solve), digits, request.sensitivities)
        require_memory(problem, request.samples or 0, self.limits.memory_mib, BYTES_IN_ARRAYS)
        return simulate(problem, request)

    @naming_the_extra()
    @takes_options(*options_of(LinearizationRequest))
    def linearize(self, options: dict[str, Any]) -> "Linearization":
        """Linearise the motion on the constraint manifold.

        Parameters
        ----------
        {options}

        Returns
        -------
        Linearization
            Matrices ``lin.A``, ``lin.eigenvalues``, ``lin.modes``, ``lin.state_space("ddot")``.

        Raises
        ------
        HolonomError
            If a control has no law or a parameter no value, if a sign changes or slides there, if a joint is released
            before, if forces contain multipliers, if the motion cannot be continued so far, or if the constraints lose
            rank there.

        Examples
        --------
        >>> scene.linearize(at=0).A.shape
        (2, 2)
        """
        from .stability.linearization import linearize

        if (name := options["equilibrium"]) is not None:
            if options["at"] is not None:
                raise HolonomError(ErrorKind.TWO_STATES)
            return self.equilibria()[name].linearization
        return linearize(*self._linear_problem(), options["at"])

    @naming_the_extra()
    @takes_options(*options_of(AlongRequest))
    def linearize_along(self, options: dict[str, Any]) -> "LinearizedMotion":
        """Linearise along the whole motion, on the constraint manifold.

        Parameters
        ----------
        {options}

        Returns
        -------
        LinearizedMotion
            ``along.A``, ``along.transition``, ``along.floquet``, ``along.free``. ``along[k]`` is a `Linearization`.

        Raises
        ------
        HolonomError
            As `linearize`, or small deviations change too fast.

        Examples
        --------
        >>> scene.linearize_along(until=1, samples=3).transition.shape
        (3, 2, 2)
        """
        from .stability.along import linearize_along

        return linearize_along(*self._linear_problem(), AlongRequest(**options))

    @takes_options(*options_of(EquilibriaRequest))
    def equilibria(self, options: dict[str, Any], **controls: Number) -> "Equilibria":
        """Search for states at rest for constant controls.

        The search is random. `Equilibria.complete` states whether it found all, if the equations are polynomial and
        small.

        Parameters
        ----------
        {options}
        **controls : number
            Values of controls. Default: the initial values of their laws. Use `branches` for a control with the name
            of an argument.

        Returns
        -------
        Equilibria
            Equilibria by name, with ``found["e1"].stability`` and ``found["e1"].linearization``.

        Raises
        ------
        HolonomError
            If the equations contain the time, a control or a parameter has no value, or the motion is not analytic.

        Examples
        --------
        >>> len(scene.equilibria())
        2
        """
        return self._equilibria(controls, **options)

    @naming_the_extra()
    def _equilibria(self, controls: Mapping[str, Number], **options: int) -> "Equilibria":
        """Search for equilibria with controls of any names."""
        from .stability.equilibria import find_equilibria

        return find_equilibria(*self._linear_problem(), _numbers(controls), **options)

    @naming_the_extra()
    def at_equilibrium(self, name: str) -> "Scene":
        """Return the scene with an equilibrium as its initial state, at rest.

        Parameters
        ----------
        name : str
            Name of the equilibrium in `equilibria`, for the initial values of the controls.

        Returns
        -------
        Scene
            A new scene.

        Raises
        ------
        HolonomError
            As `equilibria`, or if there is no equilibrium of that name.

        Examples
        --------
        >>> scene.at_equilibrium("e1").simulate(until=1, samples=2)["y"].round(9)
        array([-1., -1.])
        """
        from .stability.start import started_at_equilibrium

        source = started_at_equilibrium(self._source, self.equilibria(), name)
        return Scene(self.file, self._name, self._settings, self.limits, source)

    @takes_options(*options_of(EquilibriaRequest))
    def branches(
        self, control: str, values: Sequence[Number], options: dict[str, Any], **controls: Number
    ) -> "Branches":
        """Search for states at rest over the values of a control.

        The search is random and may miss equilibria.

        Parameters
        ----------
        control : str
            Name of the control that varies.
        values : sequence of numbers
            Values of the control. States found at one value are initial guesses at the next.
        {options}
        **controls : number
            Constant values of the other controls, as for `equilibria`.

        Returns
        -------
        Branches
            Table ``found.to_pandas()`` and diagram ``found.plot()``.

        Raises
        ------
        HolonomError
            As `equilibria`.

        Examples
        --------
        >>> scene.branches("u", [1.0]).to_pandas().shape
        (2, 5)
        """
        return self._branches(control, values, controls, **options)

    @naming_the_extra()
    def _branches(
        self, control: str, values: Sequence[Number], controls: Mapping[str, Number], **options: int
    ) -> "Branches":
        """Search for equilibria over a control, with controls of any names."""
        from .stability.branches import find_branches

        if isinstance(values, str) or not len(values):
            raise HolonomError(ErrorKind.NOT_A_SETTING, detail=f"{control}={values}")
        numbers = [_numbers({control: value})[control] for value in values]
        return find_branches(*self._linear_problem(), control, numbers, _numbers(controls), **options)

    @naming_the_extra()
    @takes_options(*options_of(DaeRequest))
    def dae(self, options: dict[str, Any]) -> "Dae":
        """Return the equations of motion as F(t, y, y') = 0, with the Jacobian.

        Parameters
        ----------
        {options}

        Returns
        -------
        Dae
            ``dae.residual(t, y, yp)``, ``dae.jacobian(t, y, yp, factor)``, ``dae.y0``, ``dae.yp0``, ``dae.algebraic``.

        Raises
        ------
        HolonomError
            If a control has no law or a parameter no value, or if the motion is not analytic.

        Examples
        --------
        >>> scene.dae().y0.shape
        (6,)
        """
        from .dae import Dae

        return Dae(*self._linear_problem(), **options)

    @naming_the_extra()
    @takes_options(*options_of(Request, "solve"))
    def rhs(self, options: dict[str, Any]) -> "RightHandSide":
        """Return the equations of motion as y' = f(t, y) for any integrator.

        y contains the coordinates, then the velocities. The control law and the values of the parameters are
        substituted. Only the accelerations satisfy the constraints: a solver may drift from them.

        Parameters
        ----------
        {options}

        Returns
        -------
        RightHandSide
            A function of t and y, shape (2n,), that returns an array of the same shape.

        Raises
        ------
        HolonomError
            If no order of pivots solves the equations of motion, for example with redundant constraints, or if the
            motion is not analytic everywhere.

        Examples
        --------
        >>> scene.rhs()(0.0, [0.6, -0.8, 0, 0]).shape
        (4,)
        """
        from .program.motion_problem import DOUBLE_DIGITS
        from .program.right_hand_side import RightHandSide
        from .program.sign_pattern import with_values_in

        return RightHandSide(with_values_in(self._problem(options["solve"], DOUBLE_DIGITS)))

    @takes_options(*options_of(Request, "solve"))
    def program(self, options: dict[str, Any]) -> MotionProgram:
        """Return the motion program: accelerations and multipliers of a state.

        Parameters
        ----------
        {options}

        Returns
        -------
        MotionProgram
            A function of (t, q, dot q, u, dot u, ddot u), in the forms in which it can be written.

        Raises
        ------
        HolonomError
            The scene does not exist.

        Examples
        --------
        >>> scene.program().document[:26]
        '{"format":"holonom-program'
        """
        return MotionProgram(self._source, self._request(**options), self.limits)

    def _linear_problem(self) -> "tuple[MotionProblem, LinearEquations]":
        """Return the motion and its linearised equations, derived in one run of Maxima."""
        from .documents import ask_later
        from .formats import Document
        from .program.motion_problem import DOUBLE_DIGITS

        if "_linear_equations" not in vars(self):
            ask_later(Document.LINEARIZATION, self._source, self._name, settings=self.settings)
        return self._problem("direct", DOUBLE_DIGITS), self._linear_equations

    @cached_property
    def _linear_equations(self) -> "LinearEquations":
        from .stability.linear_equations import linear_equations

        return linear_equations(self._source, self._request())

    def __repr__(self) -> str:
        scene = f", scene={self._name!r}" if self._name else ""
        settings = "".join(f", {name}={value}" for name, value in self.settings.items())
        return f"<Scene {str(self.file)!r}{scene}{settings}>"

    def _repr_html_(self) -> str | None:
        return self.equations._repr_html_()

    def _repr_latex_(self) -> str:
        return self.equations._repr_latex_()

    def _request(self, solve: Solve = Solve.DIRECT) -> Request:
        return Request(self._name, solve, self.settings)

    def _problem(self, solve: Solve, digits: int) -> "MotionProblem":
        return self._derived.motion(self._request(solve), digits)


def _numbers(settings: Mapping[str, Number]) -> dict[str, Fraction]:
    """Return settings as the exact numbers that are written."""
    return {name: Fraction(text) for name, text in _settings(settings).items()}


def _settings(settings: Mapping[str, Number]) -> dict[str, str]:
    """Return the settings as numbers in Maxima's notation."""
    texts = {name: repr(float(value)) if isinstance(value, float) else str(value) for name, value in settings.items()}
    return read_settings(f"{name}={text.replace('e+', 'e').replace('E+', 'e')}" for name, text in texts.items())
