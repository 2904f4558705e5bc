"""Motions of sweeps, each asked of Maxima once in a test run."""

from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

from holonom.program.motion_problem import motion_problem
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.sweeps.axes import read_axes
from holonom.sweeps.outputs import read_quantities
from holonom.sweeps.rows import Plan, RowMaker

EXAMPLES = Path(__file__).parents[2] / "examples"

Maker = Callable[..., RowMaker]


@cache
def problem_of(file: Path, scene: str | None, names: tuple[str, ...]):
    return motion_problem(file, Request(scene), Limits(), open_parameters=names)


@pytest.fixture(scope="session")
def rows_of() -> Maker:
    """What makes the rows of a scene for grids NAME=FIRST:LAST:COUNT."""

    def make(file: Path | str, keep: str, *grids: str, scene: str | None = None, **plan) -> RowMaker:
        axes = read_axes(grids, [], [], None, None)
        return RowMaker(Plan(problem_of(EXAMPLES / file, scene, axes.names), axes, read_quantities([keep]), **plan))

    return make
