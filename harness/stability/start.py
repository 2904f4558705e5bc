"""An equilibrium as the initial state of a scene."""

from collections.abc import Mapping

from ..description import Description
from ..maxima import NO_SETTINGS
from ..source import Source
from .equilibria import Equilibria


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

    @property
    def text(self) -> str:
        """Text of the file."""
        return self._source.text

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


def started_at_equilibrium(source: Source, found: Equilibria, name: str) -> Source:
    """Return the source with a scene that starts at rest in an equilibrium.

    Parameters
    ----------
    source : Source
        The scene file.
    found : Equilibria
        Equilibria of the scene, for the initial values of the controls.
    name : str
        Name of one of them.

    Returns
    -------
    Source

    Raises
    ------
    HolonomError
        There is no equilibrium of that name.
    """
    coordinates = found[name].coordinates
    at_rest = {f"dot({q})": 0.0 for q in coordinates}
    return StartedSource(source, found.scene, {**coordinates, **at_rest})
