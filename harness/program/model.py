"""A scene as a model for other programs, with open controls and parameters.

It consists of straight-line programs, in one JSON document from Maxima (`maxima/record/model.mac`). The outputs of each
program are defined in `maxima/program/model.mac`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..documents import NAME, ask
from ..failures import ErrorKind, HolonomError
from ..formats import Document, nothing_collected, read
from ..sandbox import Limits
from ..source import Source
from ..structs import structured
from .motion_program import Program
from .request import Request
from .table import Table


@dataclass(frozen=True)
class Model:
    """A scene with controls, and some parameters, as inputs."""

    system: str
    source: str
    scene: str
    title: str
    # names of n coordinates, of g multipliers, of the controls, and of the parameters that are inputs
    coordinates: tuple[str, ...]
    multipliers: tuple[str, ...]
    controls: tuple[str, ...]
    parameters: tuple[str, ...]
    values: Mapping[str, str]  # what the scene gives to these parameters, as decimal digits; some may be missing
    # the time, coordinates and velocities at the initial time, as decimal digits; None where they depend on a parameter
    # without value
    start: Mapping[str, str] | None
    # u, ``dot(u)``, ``ddot(u)`` of (t, parameters, what the tables are at t), of the controls that have a law; None
    # without one
    law: Program | None
    tables: tuple[Table, ...]  # of the law, each of more polynomials than one
    # ``ddot(q)`` and the multipliers by name. This and the next two take (t, q, dot q, u, dot u, ddot u, parameters).
    motion: Program
    # ``residual[beta]``, ``residual_rate[beta]`` and those ``J[beta,s]`` that are not zero by structure; None without a
    # constraint
    constraints: Program | None
    projection: Program  # ``position_correction[s]``, ``velocity_correction[s]``
    # the controls that servo-constraints find, by name, of the same inputs; None where they find none
    servo: Program | None = None
    # what the scene observes under names of its own, of the same inputs; None without any
    outputs: Program | None = None

    @property
    def histories(self) -> tuple[str, ...]:
        """Names of the controls and of their first and second time derivatives."""
        return tuple(history.format(name) for history in ("{}", "dot({})", "ddot({})") for name in self.controls)

    @property
    def found(self) -> tuple[str, ...]:
        """Names of the controls that servo-constraints find."""
        return () if self.servo is None else tuple(self.servo.outputs)

    @property
    def observed(self) -> tuple[str, ...]:
        """Names of the scene's own outputs."""
        return () if self.outputs is None else tuple(self.outputs.outputs)

    @property
    def state(self) -> tuple[str, ...]:
        """Names of the coordinates, then of the velocities."""
        return (*self.coordinates, *(f"dot({name})" for name in self.coordinates))

    @property
    def under_law(self) -> tuple[str, ...]:
        """Names of the controls that have a law."""
        return () if self.law is None else tuple(name for name in self.controls if name in self.law.outputs)


def scene_model(file: Source | Path, request: Request, parameters: Sequence[str], limits: Limits) -> Model:
    """Return the model of a scene by Maxima, with some of its parameters left open.

    They stay open although the scene gives them values.

    Parameters
    ----------
    file : Source or Path
        Scene file.
    request : Request
        Scene, solve and settings.
    parameters : sequence of str
        Names of the parameters to leave open.
    limits : Limits
        Limits of each run of Maxima.

    Returns
    -------
    Model

    Raises
    ------
    HolonomError
        As `holonom.maxima.ask_scene`, the file has no scene, the scene not one of the parameters, or no order of pivots
        solves its equations.
    """
    for name in parameters:
        if not NAME.fullmatch(name):
            raise HolonomError(ErrorKind.NOT_A_PARAMETER, detail=name)
    asked = (request.scene, request.solve, parameters)
    return read_model(ask(Document.MODEL, file, *asked, settings=request.settings, limits=limits))


@nothing_collected()
def read_model(text: str) -> Model:
    """Read the document of a model.

    Parameters
    ----------
    text : str
        JSON document of the model.

    Returns
    -------
    Model

    Raises
    ------
    HolonomError
        It is not such a document, or one of its programs is invalid.
    """
    document = read(Document.MODEL, text)
    system = document["system"]
    return structured(Model, document, system=system["title"], source=system["source"])
