"""The figure of the radius of convergence shows what the series say."""

from xml.etree import ElementTree

import pytest

from holonom.companion.chapter import chapters_of_the_paper
from holonom.companion.directives import FILES

SVG = "{http://www.w3.org/2000/svg}"


def test_it_names_what_it_shows(companion):
    figure = ElementTree.parse(companion / FILES / "radius.svg")
    assert "√(u₀² + 1/2)" in {"".join(element.itertext()) for element in figure.iter(f"{SVG}text")}


def test_estimated_singularities_are_the_true_ones(results):
    """They are the zeros of 1 + 2 (u0 + t)^2, a pair for each u0."""
    found = results[chapters_of_the_paper()["radius-of-convergence"].runs["radii"]]
    for u0, radius in found.items():
        assert (radius.located, len(radius.singularities)) == (False, 2)
        assert [1 + 2 * (u0 + t) ** 2 for t in radius.singularities] == pytest.approx([0, 0], abs=1e-2)
