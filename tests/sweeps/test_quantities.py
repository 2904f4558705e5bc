"""Quantities of sweeps that are made of a motion's own: against Lagrange's equations by hand."""

from dataclasses import replace
from fractions import Fraction

import pytest
from refusing import failing

from holonom.failures import ErrorKind
from holonom.program.motion_program import Call, Name, Operation, names_in
from holonom.sweeps.quantities import forces_of, observed_names, require_known, solved_names


@pytest.fixture(scope="module")
def problem(rows_of):
    """Two coordinates on a circle."""
    return rows_of("pendulum.mac", "final", "m=1:2:2").plan.problem


def test_constraint_forces_are_gradients_times_multipliers(problem):
    found, _ = forces_of(problem)
    assert [each.operation for each in found] == [Operation.ADD] * len(found)
    terms = [[set(names_in(term)) for term in each.arguments] for each in found]
    assert terms == [[{f"J[1,{s}]", problem.multipliers[0]}] for s in (1, 2)]


def test_other_forces_are_one_for_each_coordinate(problem):
    assert forces_of(problem)[1] == [Name(f"h[{s}]") for s in range(1, len(problem.coordinates) + 1)]


def test_names_are_those_that_the_motion_has(problem):
    assert solved_names(problem)[: len(problem.coordinates)] == tuple(f"ddot({q})" for q in problem.coordinates)
    assert set(problem.multipliers) <= set(solved_names(problem))
    observed = solved_names(replace(problem, observe=["constraint_forces"]))
    assert observed == (*problem.accelerations, *problem.multipliers, "Lambda[1]", "Lambda[2]")
    for name in ("t", "energy", *problem.state, *solved_names(problem), *observed_names(problem), *problem.parameters):
        require_known(problem, [Name(name), Call(Operation.ADD, (Name(name), Fraction(1)))])
    with failing(ErrorKind.NOT_AN_OUTPUT, "nowhere"):
        require_known(problem, [Name("t"), Call(Operation.ADD, (Name("t"), Name("nowhere")))])
