"""Motions of a scene file, derived once for all values of its parameters.

A setting of a parameter of the scene stays open in the programs and gets its value afterwards. Any other setting, such
as a number of masses, changes the derivation. If the equations need a number, such as a mass of zero, the motion is
derived with the numbers in it.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from ..documents import NAME
from ..failures import ErrorKind, HolonomError
from ..program.motion_problem import DOUBLE_DIGITS, DependsOn, MotionProblem, motion_problem
from ..program.request import Request
from ..source import Source

if TYPE_CHECKING:
    from .inputs import Inputs


class Derivations:
    """The derivations of a scene file by Maxima."""

    def __init__(self, source: Source) -> None:
        self._source = source
        self._opened: dict[tuple[object, ...], list[tuple[Mapping[str, str], MotionProblem]]] = {}
        self._closed: dict[tuple[object, ...], MotionProblem] = {}

    def motion(self, request: Request, digits: int = DOUBLE_DIGITS, directions: Collection[str] = ()) -> MotionProblem:
        """Return the motion that a request asks for.

        Its open parameters, if it has any, have the values of the settings.

        Parameters
        ----------
        request : Request
            Scene, solve and settings.
        digits : int
            Decimal digits of the initial values.
        directions : collection of str
            Names by which derivatives are requested. Parameters among them stay open, with the scene's values.

        Returns
        -------
        MotionProblem

        Raises
        ------
        HolonomError
            As `motion_problem`.
        """
        names = open_names(request, digits, directions)
        request = replace(request, derivatives=bool(directions))
        opened = self._at_settings(request, names) if names else None
        return self._with_numbers(request, digits) if opened is None else opened

    def _with_numbers(self, request: Request, digits: int) -> MotionProblem:
        key = (request.scene, request.solve, request.derivatives, digits, *sorted(request.settings.items()))
        if key not in self._closed:
            self._closed[key] = motion_problem(self._source, request, self._source.limits, digits)
        return self._closed[key]

    def _at_settings(self, request: Request, names: tuple[str, ...]) -> MotionProblem | None:
        """Return the motion with open parameters set, or None if numbers are needed."""
        known = self._opened.setdefault((request.scene, request.solve, request.derivatives, names), [])
        for settings, problem in known:
            fixed = [name for name in names if not (name in problem.parameters and name in request.settings)]
            if all(settings.get(name) == request.settings.get(name) for name in fixed):
                return _moved(problem, request.settings)
        problem = motion_problem(self._source, request, self._source.limits, DOUBLE_DIGITS, names)
        known.append((request.settings, problem))
        return _moved(problem, request.settings)


def open_names(request: Request, digits: int, also_open: Collection[str] = ()) -> tuple[str, ...]:
    """Return the names of parameters to leave open, in double precision only.

    Parameters
    ----------
    request : Request
        Its settings name the parameters.
    digits : int
        Decimal digits of the initial values.
    also_open : collection of str
        Further names.

    Returns
    -------
    tuple of str
        In alphabetical order. Empty beyond double precision.
    """
    names = {name for name in (*request.settings, *also_open) if NAME.fullmatch(name)}
    return tuple(sorted(names)) if digits == DOUBLE_DIGITS else ()


def stands(problem: MotionProblem) -> bool:
    """Return True if the programs of a motion have finite values at the initial time.

    It is True if no parameter is open.

    Parameters
    ----------
    problem : MotionProblem
        The motion, with values of its open parameters.

    Returns
    -------
    bool
    """
    if not problem.parameters:
        return True
    if problem.motion is None:
        return False
    import numpy as np

    from ..program.numpy_function import NumpyFunction
    from ..program.sign_pattern import at_start
    from .inputs import Inputs
    from .matrices import start_of

    begun = at_start(problem)
    function = problem.once("start", begun.motion, lambda: NumpyFunction(begun.motion))
    inputs, start = Inputs(begun), start_of(begun)
    with np.errstate(all="ignore"):
        return bool(np.isfinite(function(inputs(*start, signs=_signs_at(begun, inputs, *start)))).all())


def _signs_at(problem: MotionProblem, inputs: "Inputs", t: float, state: Sequence[float]) -> list[float]:
    """Return the signs at a state, those of multipliers as positive.

    Each is known after those that its function contains.
    """
    from ..program.numpy_function import NumpyFunction
    from ..program.rewriting import computing

    def build() -> dict[str, NumpyFunction]:
        names = [sign.name for sign in problem.signs if sign.by is not DependsOn.REACTION]
        return {
            name: NumpyFunction(computing(problem.switching, {f"switch[{problem.places[name]}]"})) for name in names
        }

    signs = dict.fromkeys(problem.places, 1.0)
    for name, function in problem.once("start signs", problem.switching, build).items():
        signs[name] = -1.0 if function(inputs(t, state, signs=[*signs.values()]))[0] < 0 else 1.0
    return [*signs.values()]


def _moved(problem: MotionProblem, settings: Mapping[str, str]) -> MotionProblem | None:
    """Return the motion for other settings, or None if its programs or start fail."""
    from .initial_state import at_values

    if not problem.parameters:
        return problem  # the setting is not a parameter, as the length of a chain
    values = {
        name: Fraction(settings[name]) if name in settings else problem.values[name] for name in problem.parameters
    }
    try:
        moved = at_values(problem, values)
    except HolonomError as error:
        if error.kind is not ErrorKind.NO_INITIAL_STATE:
            raise
        if values != problem.values:
            return None
        moved = problem  # Maxima has found the initial state for these
    return moved if stands(moved) else None
