"""Drift of a pendulum at a coarse tolerance: each stabilization reduces it, and all are drawn."""

from pathlib import Path
from xml.etree import ElementTree

import pytest

from holonom.companion.further_runs import COARSE, SWING, drifting
from holonom.figures.curves import draw_drift
from holonom.simulation.request import Stabilization

PENDULUM = Path(__file__).parents[2] / "examples" / "pendulum.mac"
SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def motions():
    return drifting(PENDULUM, SWING)


@pytest.mark.parametrize("stabilization", [Stabilization.BAUMGARTE, Stabilization.GGL])
def test_a_stabilization_keeps_nearer_to_the_constraint_than_none(motions, stabilization):
    assert (
        max(motions[stabilization].residuals["position"]) < max(motions[Stabilization.NONE].residuals["position"]) / 5
    )


def test_projection_keeps_the_drift_within_the_tolerance(motions):
    """States are projected where their drift is near it."""
    projected, drifting = (
        motions[each].residuals["position"] for each in (Stabilization.PROJECTION, Stabilization.NONE)
    )
    assert max(projected) < COARSE < max(drifting)
    assert projected[-1] < 1e-6 * COARSE


def test_every_stabilization_has_its_line_and_the_figure_is_the_same_each_time(motions):
    svg = draw_drift(motions)
    texts = {"".join(each.itertext()) for each in ElementTree.fromstring(svg).iter(f"{SVG}text")}
    assert set(Stabilization) <= texts
    assert svg == draw_drift(motions)
