"""The figure of the radius of convergence shows what the series say."""

from xml.etree import ElementTree

import pytest
from shorter import FEW_ORDERS

from holonom.companion import convergence
from holonom.companion.chapter import chapters_of_the_paper

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def figure(results):
    found = results[chapters_of_the_paper()["radius-of-convergence"].runs["radius"]]
    with pytest.MonkeyPatch.context() as few:
        few.setattr(convergence, "ORDERS_OF_RADII", FEW_ORDERS)
        return ElementTree.fromstring(convergence.draw_radius(found))


def test_it_names_what_it_shows(figure):
    texts = {"".join(element.itertext()) for element in figure.iter(f"{SVG}text")}
    assert {"√(u₀² + 1/2)", "u = u₀ + t, 30 orders", "u = u₀ exp(t): entire", "u₀ = 0.3"} <= texts


def test_estimated_singularities_lie_on_the_true_ones(figure):
    """Each mark of an estimate is centred, to the width of a line, in the ring around a zero of 1 + 2 (u0 + t)^2."""
    panel = figure.find(f".//{SVG}g[@id='axes_2']")
    for legend in panel.findall(f"{SVG}g[@id='legend_2']"):
        panel.remove(legend)
    marks = [(complex(float(use.get("x")), float(use.get("y"))), use.get("style")) for use in panel.iter(f"{SVG}use")]
    estimated = [z for z, style in marks if "currentColor" not in style]
    true = [z for z, style in marks if "currentColor" in style]
    assert len(estimated) == 4
    assert all(min(abs(z - ring) for ring in true) < 1 for z in estimated)
