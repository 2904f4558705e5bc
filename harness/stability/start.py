"""An equilibrium as the initial state of a scene."""

from collections.abc import Mapping

from ..description import Description
from ..maxima import NO_SETTINGS
from ..program.motion_problem import motion_problem
from ..program.request import Request
from ..sandbox import Limits
from ..source import Source
from .equilibria import find_equilibria
from .linear_equations import linear_equations
from .request import EquilibriaRequest


class StartedSource(Source):
    """A source in which one scene has another initial state.

    Parameters
    ----------
    source : Source
        The source of the other scenes, and of everything else in this one.
    scene : str
        Name of the scene.
    state : mapping of str to float
        Its initial coordinates and velocities.
    """

    def __init__(self, source: Source, scene: str, state: Mapping[str, float]) -> None:
        super().__init__(source.file, source.limits)
        self._source, self._scene, self._state = source, scene, state

    def description(self, settings: Mapping[str, str] = NO_SETTINGS) -> Description:
        """Return the description of the file under settings, with this initial state.

        Parameters
        ----------
        settings : mapping of str to str
            As for `Source.description`.

        Returns
        -------
        Description
        """
        return self._source.description(settings).with_initial_state(self._scene, self._state)


def started_at_equilibrium(source: Source, request: Request, limits: Limits, name: str) -> Source:
    """Return the source with a scene that starts at rest in an equilibrium.

    Parameters
    ----------
    source : Source
        The scene file.
    request : Request
        Scene and settings.
    limits : Limits
        Limits of each run of Maxima.
    name : str
        Name of the equilibrium, as `holonom equilibria` lists it for the initial values of the controls.

    Returns
    -------
    Source

    Raises
    ------
    HolonomError
        As `find_equilibria`, or there is no equilibrium of that name.
    """
    problem, asked = motion_problem(source, request, limits), EquilibriaRequest()
    found = find_equilibria(problem, linear_equations(source, request), {}, asked.starts, asked.seed)[name]
    at_rest = dict.fromkeys(problem.state, 0.0)
    return StartedSource(source, problem.scene, at_rest | dict(found.coordinates))
