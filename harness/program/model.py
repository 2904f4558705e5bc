"""A scene as a model for other programs: straight-line programs in which controls and parameters are still open.

One JSON document from Maxima, `maxima/record/model.mac`; `maxima/program/model.mac` says what each program computes.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..confined import Limits
from ..documents import NAME, Document, ask, read
from ..failures import Failure, HolonomError
from .motion_program import Program, program_of
from .request import Request


@dataclass(frozen=True)
class Model:
    """A scene whose controls, and some of whose parameters, are inputs.

    Attributes
    ----------
    coordinates, multipliers, controls, parameters : tuple of str
        Their names: n, g, alpha and those of the parameters that are inputs.
    values : mapping of str to str
        What the scene gives to these parameters, as decimal digits; some may be missing.
    start : mapping of str to str, or None
        The time, coordinates and velocities at the start, as decimal digits; None where they depend on a parameter
        without value.
    law : Program or None
        u, ``dot(u)``, ``ddot(u)`` of (t, parameters), of the controls that have a law; None without one.
    motion : Program
        ``ddot(q)`` and the multipliers by name. This and the next two take (t, q, dot q, u, dot u, ddot u, parameters).
    constraints : Program or None
        ``residual[beta]``, ``residual_rate[beta]`` and those ``J[beta,s]`` that are not zero by structure; None without
        a constraint.
    projection : Program
        ``position_correction[s]``, ``velocity_correction[s]``.
    """

    system: str
    source: str
    scene: str
    title: str
    coordinates: tuple[str, ...]
    multipliers: tuple[str, ...]
    controls: tuple[str, ...]
    parameters: tuple[str, ...]
    values: Mapping[str, str]
    start: Mapping[str, str] | None
    law: Program | None
    motion: Program
    constraints: Program | None
    projection: Program

    @property
    def under_law(self) -> tuple[str, ...]:
        """Names of the controls that have a law."""
        return () if self.law is None else tuple(name for name in self.controls if name in self.law.outputs)


def scene_model(file: Path, request: Request, parameters: Sequence[str], limits: Limits) -> Model:
    """Ask Maxima for a scene as a model.

    Parameters
    ----------
    parameters : sequence of str
        Those that stay open although the scene gives them values.

    Raises
    ------
    HolonomError
        As `holonom.maxima.ask_scene`; the file has no scene, the scene not one of the parameters; no order of pivots
        solves its equations.
    """
    for name in parameters:
        if not NAME.fullmatch(name):
            raise HolonomError(Failure.NOT_A_PARAMETER, detail=name)
    asked = (request.scene, request.solve, parameters)
    return read_model(ask(Document.MODEL, file, *asked, settings=request.settings, limits=limits))


def read_model(text: str) -> Model:
    """Read the document of a model.

    Raises
    ------
    HolonomError
        It is no such document, or one of its programs is no program.
    """
    document = read(Document.MODEL, text)
    names = {kind: tuple(document[kind]) for kind in ("coordinates", "multipliers", "controls", "parameters")}
    programs = {
        part: document[part] and program_of(document[part]) for part in ("law", "motion", "constraints", "projection")
    }
    return Model(
        system=document["system"]["title"],
        source=document["system"]["source"],
        scene=document["scene"],
        title=document["title"],
        values=document["values"],
        start=document["start"],
        **names,
        **programs,
    )
