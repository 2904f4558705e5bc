"""What is out of proportion to its tolerance is no result."""

import math

from holonom.simulation.trust import doubts

KEPT = {"position": 1e-16, "velocity": 1e-15, "acceleration": 1.0}


def test_the_errors_of_a_motion_that_was_followed_are_in_proportion():
    assert not list(doubts(KEPT, 1e-12, 10.0, 1e-16, 500))


def test_a_position_residual_of_0_04_and_an_energy_error_of_13_were_passed_over():
    found = list(doubts({**KEPT, "position": 0.04}, 13.0, 40.0, 1e-16, 100))
    assert [doubt.quantity for doubt in found] == ["position", "energy"]
    assert found[1].missed == 13.0 / 40.0


def test_what_is_no_number_is_no_result():
    assert [doubt.quantity for doubt in doubts(KEPT, math.nan, 1.0, 1e-3, 10)] == ["energy"]
