"""Contacts that stick while others touch down."""

import pytest

import holonom

TWO_CORNERS = """
n : [sin(1/10), cos(1/10)]$
along : [cos(1/10), -sin(1/10)]$
box : planar_body(33/20, 1/20, [x, y], phi)$
first_corner : marker(box, [-3/20, 7/20])$
second_corner : marker(box, [3/10, -1/20])$
contact(p) := applied_force(
  200*max(0, -(position(p) . n))^(3/2)*(n - 3/4*signum(velocity(p) . along)*along), p)$
system : holonomic_system(assembly(box, uniform_gravity(981/100, box), contact(first_corner), contact(second_corner)))$
fall : holonomic_scene(system, time_span = [0, 9/10],
  initial_state = [x = -1/4, y = 29/20, phi = -51/20, dot(x) = -1/10, dot(y) = -1, dot(phi) = -47/20])$
"""


@pytest.mark.parametrize("engine", ["taylor", "runge-kutta", "robust"])
def test_a_corner_that_sticks_while_another_touches_down(engine):
    """Rounding had put the other corner's depth below zero, where its root has no value."""
    scene = holonom.system(TWO_CORNERS)
    found, other = scene.simulate(engine=engine, samples=2).report, scene.simulate(max_step=0.01, samples=2).report
    assert found.coordinates == pytest.approx(other.coordinates, abs=1e-8)
    assert [each.outcome for each in found.switchings] == [each.outcome for each in other.switchings]
    assert [each.t for each in found.switchings] == pytest.approx([each.t for each in other.switchings], abs=1e-8)
