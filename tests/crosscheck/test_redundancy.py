"""Constraints that are said to follow from the others: found where they do, and where they do not."""

import dataclasses

import pytest
from refusing import refused

import holonom
from holonom.crosscheck.check import check_record
from holonom.crosscheck.report import Verdict

SLIDE = """
system : holonomic_system(coordinates = [x, y, z], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2 + dot(z)^2)/2,
  potential_energy = [gravity = 10*y], constraints = [x^2 + y^2 - u^2, z - x, (x^2 + y^2)^2 - u^4 + z - x])$
"""
SCENE = "scene : holonomic_scene(system, control_law = [u = 1 + t], initial_state = [x = 3/5, y = 4/5, dot(x) = 0])$"


@pytest.fixture(scope="module", params=[SLIDE, SLIDE + SCENE], ids=["without a scene", "near its start"])
def scene(request):
    return holonom.system(request.param)


@pytest.fixture
def record(scene):
    return scene.record


def verdicts_of(record, scene):
    return {found.id: found.verdict for found in check_record(record, scene.description).verdicts}


def test_a_constraint_that_follows_from_two_others_is_named_and_the_rest_is_proved(record, scene):
    assert record.derivations[0].redundant == ("lambda3",)
    found = verdicts_of(record, scene)
    assert found["redundant_constraints"] is Verdict.AGREES
    assert found["constraint_forces"] is found["accelerations"] is Verdict.PROVED


def test_a_constraint_that_does_not_follow_from_the_others_is_found(record, scene):
    derived = dataclasses.replace(record.derivations[0], redundant=("lambda2", "lambda3"))
    found = verdicts_of(dataclasses.replace(record, derivations=(derived,)), scene)
    assert found["redundant_constraints"] is Verdict.DISAGREES
    assert found["constraint_forces"] is Verdict.DISAGREES


def test_a_constraint_that_follows_and_is_not_listed_is_found(record, scene):
    derived = dataclasses.replace(record.derivations[0], redundant=())
    found = verdicts_of(dataclasses.replace(record, derivations=(derived,)), scene)
    assert found["redundant_constraints"] in (Verdict.DISAGREES, Verdict.UNDECIDED)


GUIDES = """
system : holonomic_system(coordinates = [x, y], parameters = [a], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  constraints = [y - x, {second}])$
scene : holonomic_scene(system, parameter_values = [a = {a}],
  initial_state = [x = 0, y = 0, dot(x) = 0, dot(y) = 0])$
"""


@pytest.mark.parametrize(("a", "verdict"), [(1, Verdict.UNDECIDED), (2, Verdict.AGREES)])
def test_constraints_that_are_independent_but_for_the_value_of_a_parameter(a, verdict):
    scene = holonom.system(GUIDES.format(second="y - a*x", a=a))
    assert scene.record.derivations[0].redundant == ()
    assert verdicts_of(scene.record, scene)["redundant_constraints"] is verdict


def test_a_constraint_that_follows_for_all_values_and_is_not_listed_is_found():
    scene = holonom.system(GUIDES.format(second="a*y - a*x", a=1))
    assert scene.record.derivations[0].redundant == ("lambda2",)
    derived = dataclasses.replace(scene.record.derivations[0], redundant=())
    found = verdicts_of(dataclasses.replace(scene.record, derivations=(derived,)), scene)
    assert found["redundant_constraints"] is Verdict.DISAGREES


@pytest.mark.parametrize("flat", ["t^6", "t^41", "t^12", "sin(t)^8", "exp(-10*(t - 5)^2)", "w^10"])
def test_constraints_that_contradict_each_other_later_were_redundant(flat):
    """The motion was free: near the initial time the second constraint nearly holds."""
    text = GUIDES.replace("parameters = [a]", "controls = [w]" if "w" in flat else "parameters = []")
    text = text.replace("parameter_values = [a = {a}]", "control_law = [w = t]" if "w" in flat else 'title = "flat"')
    with refused("irregular_constraints"):
        holonom.system(text.format(second=f"y - x - {flat}")).free()
