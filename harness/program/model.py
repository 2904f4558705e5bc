"""A scene as a model for other programs, with open controls and parameters.

It consists of straight-line programs, in one JSON document from Maxima (`maxima/record/model.mac`). The outputs of each
program are defined in `maxima/program/model.mac`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ..described import SystemTitle
from ..documents import NAME, ask
from ..failures import ErrorKind, HolonomError
from ..formats import Document, read
from ..sandbox import Limits
from ..schema import Names, NumberText
from ..source import Source
from ..structs import entry, structured
from .motion_program import LAW_SPAN, LawSpan, Program
from .request import Request
from .table import Table

PROGRAMS = ("law", "motion", "constraints", "projection", "servo", "outputs")


@dataclass(frozen=True)
class Model:
    """A scene with controls, and some parameters, as inputs."""

    system: SystemTitle = entry("The system.")
    scene: str = entry("Name that the scene is assigned to.")
    title: str = entry("Title of the scene.")
    coordinates: Names = entry("The n coordinates.")
    multipliers: Names = entry("The g multipliers, one for each constraint.")
    controls: Names = entry("The controls, which are inputs.")
    parameters: Names = entry("Parameters that stay open: inputs, too.")
    values: Mapping[str, NumberText] = entry("The scene's values of the parameters that stay open.")
    start: Mapping[str, NumberText] | None = entry(
        "t, coordinates and velocities at the initial time; null if they depend on a parameter without value."
    )
    law: Program | None = entry(
        "Program of (t, parameters, what the tables are at t): u, dot(u), ddot(u) of the controls with a law; "
        "null without a law."
    )
    tables: tuple[Table, ...] = entry(
        "Tables of the law: names of a polynomial's t_k, c0, c1, c2, c3 among the inputs, and the polynomials in "
        "order, c0 + c1 tau + c2 tau^2 + c3 tau^3 with tau = t - t_k."
    )
    motion: Program = entry(
        "The motion program of (t, q, dot q, u, dot u, ddot u, parameters): accelerations and multipliers."
    )
    constraints: Program | None = entry(
        "Program: residual[b], residual_rate[b], and the entries J[b,s] that are not zero; null without a constraint."
    )
    projection: Program = entry("Program: position_correction[s] and velocity_correction[s].")
    servo: Program | None = entry(
        "Program of the same inputs as motion: the controls that servo-constraints find, by name; "
        "null where they find none.",
        None,
    )
    outputs: Program | None = entry("Program: what the scene observes under names of its own; null without any.", None)
    law_span: LawSpan | None = entry(LAW_SPAN, None)

    @staticmethod
    def of_document(document: Mapping[str, Any]) -> "Model":
        """Read the document of a model.

        Parameters
        ----------
        document : mapping
            Decoded JSON.

        Returns
        -------
        Model
            Each program with the span of the functions of time.
        """
        model = structured(Model, document)
        programs = {name: getattr(model, name) for name in PROGRAMS}
        return replace(
            model, **{name: program and replace(program, law_span=model.law_span) for name, program in programs.items()}
        )

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
        As `holonom.documents.ask`, the file has no scene, the scene not one of the parameters, or no order of pivots
        solves its equations.
    """
    for name in parameters:
        if not NAME.fullmatch(name):
            raise HolonomError(ErrorKind.NOT_A_PARAMETER, detail=name)
    asked = (request.scene, request.solve, parameters)
    text = ask(Document.MODEL, file, *asked, settings=request.settings, limits=limits)
    return read(Document.MODEL, text, Model)
