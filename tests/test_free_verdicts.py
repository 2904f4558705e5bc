"""Verdicts on free motion that contradict the equations of motion, or each other, become undecided."""

import pytest
import sympy as sp

from holonom.crosscheck.report import CheckResult
from holonom.crosscheck.system import MechanicalSystem, dotted
from holonom.crosscheck.verdict import Verdict
from holonom.free_verdicts import FreeMotionTrial

t, u, x, y = sp.symbols("t u x y", real=True, seq=True)
HALF = (sp.Integer(0), sp.Rational(1, 2))


def trial(force, span=HALF) -> FreeMotionTrial:
    energy = (dotted("dot", x) ** 2 + dotted("dot", y) ** 2) / 2
    multiplier = sp.Symbol("lambda1", real=True)
    system = MechanicalSystem(t, (x, y), (u,), (multiplier,), energy, sp.Integer(0), (force, sp.Integer(0)), (x,))
    return FreeMotionTrial(system, {}, span)


ROOT = trial(((1 - t) * u**2 - 1) * y)
GOOD, BAD, OPEN = (
    CheckResult(verdict, None, None, "why") for verdict in (Verdict.AGREES, Verdict.DISAGREES, Verdict.UNDECIDED)
)


def test_no_law_is_undecided_if_the_search_finds_one():
    verdict, reason = ROOT.verdict_on_laws("none", [])
    assert (verdict, bool(reason)) == ("undecided", True)


def test_no_law_stays_if_the_search_finds_none():
    assert trial((1 + t * u**2) * y).verdict_on_laws("none", []) == ("none", "")


@pytest.mark.parametrize(
    ("checks", "verdict"), [([GOOD], "all"), ([GOOD, BAD], "undecided"), ([GOOD, OPEN], "some"), ([OPEN], "undecided")]
)
def test_laws_have_to_make_random_motions_free(checks, verdict):
    assert ROOT.verdict_on_laws("all", checks)[0] == verdict


@pytest.mark.parametrize(
    ("law", "verdict"),
    [
        (1 / sp.sqrt(1 - t), Verdict.AGREES),
        (1 / sp.sqrt(1 + t), Verdict.DISAGREES),
        (1 / sp.sqrt(t - 1), Verdict.UNDECIDED),
    ],
    ids=["free", "not free", "imaginary on the span"],
)
def test_laws_are_tried_on_the_time_span(law, verdict):
    assert ROOT.of_law({"u": law}).verdict is verdict


def test_motion_free_for_all_states_is_tried_under_its_law():
    assert ROOT.contradiction_of_free_motion({"u": 1 / sp.sqrt(1 - t)}) == ""
    assert "lambda1" in ROOT.contradiction_of_free_motion({"u": sp.Integer(1)})
