"""What the check asks Maxima about a scene."""

from types import SimpleNamespace

import pytest

from holonom.crosscheck.questions import MOST_COORDINATES, _series


@pytest.mark.parametrize(
    ("coordinates", "text", "is_asked"),
    [(2, '"Sin"', True), (2, '"Gamma"', False), (MOST_COORDINATES, "", True), (MOST_COORDINATES + 1, "", False)],
)
def test_no_series_is_asked_of_special_functions_or_of_many_coordinates(coordinates, text, is_asked):
    system = SimpleNamespace(coordinates=("x",) * coordinates)
    description = SimpleNamespace(system=system, text=text, scenes=[SimpleNamespace(name="run")])
    assert list(_series(description)) == ["run"] * is_asked
