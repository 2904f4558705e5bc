"""The longest of the companion's runs to a smaller extent, for tests of the pages; they have tests of their own."""

from fractions import Fraction

import pytest

from holonom.benchmark.work_precision.study import Plan, Study, study
from holonom.companion import INITIAL_SCENE, PAPER, convergence
from holonom.companion.chapter import chapters_of_the_paper
from holonom.companion.runs import Run
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.series.radius import Radius


def few_radii() -> dict[float, Radius]:
    with pytest.MonkeyPatch.context() as few:
        few.setattr(convergence, "ORDER", 40)
        return convergence.find_radii((Fraction(-1), Fraction(0), Fraction(3, 10)))


def coarse_study() -> Study:
    plan = Plan(tolerances={"double": (1e-4, 1e-8)}, solver_tolerances=(1e-4, 1e-8), orders=(10, 20))
    return study(PAPER, Request(INITIAL_SCENE), Limits(), plan)


CASES = chapters_of_the_paper()["hard-cases"].runs
LONG_CASES = ("spring 1e6 times stiffer", "parallelogram through its dead centres", "redundant spatial mechanism")
SHORTER = {
    **{CASES[name]: CASES["parallel constraints"] for name in LONG_CASES},
    chapters_of_the_paper()["radius-of-convergence"].runs["radii"]: Run(few_radii),
    chapters_of_the_paper()["work-precision"].runs["study"]: Run(coarse_study),
}
