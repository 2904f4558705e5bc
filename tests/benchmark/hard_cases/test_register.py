"""The register in its short form: every case holds against its truth, and the methods it warns of lose theirs."""

import pytest

from holonom.benchmark.hard_cases.case import CaseReport, Extent, Outcome, examined
from holonom.benchmark.hard_cases.register import REGISTER
from holonom.benchmark.hard_cases.runs import BASELINE
from holonom.benchmark.hard_cases.solves import DIRECT, ORTHOGONAL, PIVOTED, TEXTBOOK
from holonom.simulation.hard_cases import Difficulty

LOSING = {
    "parallel constraints": {TEXTBOOK, DIRECT},
    "constraint given twice": {BASELINE},
    "redundant spatial mechanism": {BASELINE},
    "parallelogram through its dead centres": {BASELINE},
    "mass ratio of 1e12": {TEXTBOOK, DIRECT},
}


@pytest.fixture(scope="module", params=REGISTER, ids=lambda case: case.name)
def report(request) -> CaseReport:
    return examined(request.param, Extent.SHORT)


@pytest.mark.long
def test_ours_hold_and_the_plain_ways_lose_where_the_case_is_hard_for_them(report):
    failing = [result for result in report.results if result.outcome is Outcome.FAILS]
    assert not failing
    losing = {result.method for result in report.results if result.outcome is Outcome.LOSES}
    assert losing >= LOSING.get(report.case.name, set())


def test_register_meets_every_kind_of_hard_case():
    assert {case.kind for case in REGISTER} == set(Difficulty)
    assert len({case.name for case in REGISTER}) == len(REGISTER)


def test_parallel_constraints_cost_the_orthogonal_solve_half_of_the_digits():
    """Digits are lost like log10(1/angle), not like twice that, down to where nothing of G is left."""
    case = next(case for case in REGISTER if case.name == "parallel constraints")
    sweep = examined(case, Extent.SHORT).sweep
    by_angle = {method: dict(zip(sweep.values, row, strict=True)) for method, row in sweep.digits.items()}
    for method in (ORTHOGONAL, PIVOTED):
        lost = by_angle[method][1e-2] - by_angle[method][1e-6]
        assert lost == pytest.approx(4, abs=1)
    for method in (TEXTBOOK, DIRECT):
        lost = by_angle[method][1e-2] - by_angle[method][1e-6]
        assert lost == pytest.approx(8, abs=1.5)
    assert by_angle[ORTHOGONAL][1e-7] >= 8 > 4 > by_angle[TEXTBOOK][1e-7]
