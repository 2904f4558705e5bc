"""The third opinion, on systems with every kind of term."""

import dataclasses

import pytest
import sympy as sp
from systems import charge_in_crossed_fields, paper_example, pendulum

from holonom.crosscheck.independent import IndependentEquations
from holonom.crosscheck.lagranges_method import LARGEST_SYSTEM, can_take, compare
from holonom.crosscheck.report import Verdict
from holonom.crosscheck.system import MechanicalSystem
from holonom.crosscheck.verdict import verify


@pytest.mark.parametrize(
    "system", [paper_example(), pendulum(), charge_in_crossed_fields()], ids=lambda s: s.coordinates
)
def test_lagranges_method_gives_the_same_accelerations_and_multipliers(
    system: MechanicalSystem,
) -> None:
    found = verify(compare(IndependentEquations(system)), "third opinion")
    assert found.verdict is Verdict.AGREES, found.detail


def test_a_potential_with_a_kink_had_no_regular_point() -> None:
    smooth = pendulum()
    kinked = dataclasses.replace(smooth, potential_energy=smooth.potential_energy + 20 * sp.Abs(smooth.coordinates[0]))
    assert verify(compare(IndependentEquations(kinked)), "third opinion").verdict is Verdict.AGREES


def test_a_system_without_constraints_is_taken() -> None:
    free = dataclasses.replace(pendulum(), multipliers=(), constraints=())
    assert verify(compare(IndependentEquations(free)), "free").verdict is Verdict.AGREES


def test_a_multiplier_of_the_other_sign_is_found() -> None:
    comparison = compare(IndependentEquations(pendulum()))
    multiplier = comparison.pairs[-1]
    turned = multiplier._replace(derived=-multiplier.derived)
    found = verify(dataclasses.replace(comparison, pairs=(turned,)), "third opinion")
    assert found.verdict is Verdict.DISAGREES
    assert "lambda1" in found.detail


def two_constraints() -> MechanicalSystem:
    """The paper's example with q1 equal to the control as well."""
    system = paper_example()
    constraints = (*system.constraints, system.coordinates[0] - system.controls[0])
    return dataclasses.replace(system, constraints=constraints, multipliers=tuple(sp.symbols("lambda1:3", real=True)))


def test_a_system_of_two_constraints_is_taken_and_one_too_large_is_not() -> None:
    assert can_take(two_constraints())
    assert verify(compare(IndependentEquations(two_constraints())), "two").verdict is Verdict.AGREES
    many = tuple(sp.symbols(f"q1:{LARGEST_SYSTEM + 1}", real=True))
    assert not can_take(dataclasses.replace(pendulum(), coordinates=many))


@pytest.mark.parametrize("wrong", ["forces", "constraints"])
def test_the_method_is_compared_with_our_equations_and_not_with_itself(wrong: str) -> None:
    """Ours are made those of another system: of another force, and of another constraint."""
    system = charge_in_crossed_fields()
    others = dataclasses.replace(system, **{wrong: tuple(2 * each + 1 for each in getattr(system, wrong))})
    known = IndependentEquations(system)
    known.__dict__["bordered"] = IndependentEquations(others).bordered
    assert verify(compare(known), "third opinion").verdict is Verdict.DISAGREES
