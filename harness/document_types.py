"""The type of each document, and its schema."""

from typing import Any

from .benchmark.hard_cases.case import CaseReports
from .benchmark.work_precision.series import SeriesCosts
from .benchmark.work_precision.study import Study
from .crosscheck.report import CheckedFile
from .description import DescriptionDocument
from .errata import Errata
from .formats import VERSION, Document, Publication
from .free_document import FreeMotionText
from .free_motion import FreeMotion
from .installation import Installation, MaximaVersions
from .program.effects import Costs, MeasuredCosts
from .program.model import Model
from .program.motion_problem import MotionProblem
from .program.motion_program import Program
from .record import Record
from .schema import schema_of
from .series.power_series import MotionSeries, SeriesDocument
from .simulation.result import SimulationDocument
from .stability.along import LinearizedMotion
from .stability.equilibria import Equilibria
from .stability.linear_equations import LinearEquations
from .stability.linearization import Linearization
from .sweeps.dataset import SweepDocument

TYPES = {
    Document.DESCRIPTION: DescriptionDocument,
    Document.RECORD: Record,
    Document.PROGRAM: Program,
    Document.EFFECTS: Costs,
    Document.MODEL: Model,
    Document.MOTION_PROBLEM: MotionProblem,
    Document.LINEARIZATION: LinearEquations,
    Document.MOTION_SERIES: MotionSeries,
    Document.SERIES_COSTS: SeriesCosts,
    Document.FREE_MOTION: FreeMotion,
    Document.ERRATA: Errata,
    Document.VERSIONS: MaximaVersions,
    Publication.DOCTOR: Installation,
    Publication.COSTS: MeasuredCosts,
    Publication.EQUILIBRIA: Equilibria,
    Publication.LINEARIZED: Linearization,
    Publication.LINEARIZED_ALONG: LinearizedMotion,
    Publication.CHECK: CheckedFile,
    Publication.SERIES: SeriesDocument,
    Publication.SIMULATION: SimulationDocument,
    Publication.SWEEP: SweepDocument,
    Publication.HARD_CASES: CaseReports,
    Publication.ACCURACY: Study,
    Publication.FREE: FreeMotionText,
}


def schema(name: str) -> dict[str, Any]:
    """Return the JSON schema of a format.

    Parameters
    ----------
    name : str
        Name of the format without ``holonom-``.

    Returns
    -------
    dict
    """
    return schema_of(TYPES[name], name, VERSION)
