"""Motions of the examples, each asked of Maxima once in a test run."""

from functools import cache
from pathlib import Path

from holonom.program.motion_problem import MotionProblem, motion_problem
from holonom.program.request import Request
from holonom.sandbox import Limits

EXAMPLES = Path(__file__).parents[2] / "examples"


@cache
def problem(
    file: str, scene: str | None = None, digits: int = 17, open_parameters: tuple[str, ...] = (), **settings: str
) -> MotionProblem:
    return motion_problem(EXAMPLES / file, Request(scene, settings=settings), Limits(), digits, open_parameters)
