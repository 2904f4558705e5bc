"""A mass matrix that only the constraints make regular: derived, and every equation proved."""

import dataclasses

import pytest

from holonom.crosscheck.check import check_record
from holonom.crosscheck.report import Verdict
from holonom.record import Record, derived_record
from holonom.source import Source

# A spring on a massless hook, which a cart of mass m and a winch move: lambda1 = k z by the hook's own equation.
MASSLESS_HOOK = """
load("holonom.mac")$
system : holonomic_system(
  coordinates = [x, z], controls = [u], parameters = [m, k],
  kinetic_energy = m*dot(x)^2/2, potential_energy = k*z^2/2, constraints = [z - x - u^2])$
scene : holonomic_scene(system, control_law = [u = 1 + t], parameter_values = [m = 1, k = 2],
  initial_state = [x = 1, dot(x) = 0], time_span = [0, 1])$
"""


NUMERICAL = ("lagranges_method", "redundant_constraints")  # verdicts that are never proofs


@pytest.fixture
def source(write_scene) -> Source:
    return Source(write_scene(MASSLESS_HOOK))


@pytest.fixture
def record(source) -> Record:
    return derived_record(source)


def test_every_equation_is_proved(record, source):
    report = check_record(record, source.description())
    with_verdicts = {found.verdict for found in report.verdicts if found.id not in NUMERICAL}
    assert with_verdicts - {Verdict.NOTHING} == {Verdict.PROVED}
    assert not report.disagreements
    assert {found.number for found in report.verdicts} >= {"4", "5", "8", "9", "10", "11", "13", "18"}


def test_the_multiplier_is_the_spring_force(record):
    (solved,) = [e for e in record.derivations[0].equations if e.id == "multipliers"]
    assert [str(relation.right) for relation in solved.relations] == ["k*z"]


def test_a_singular_mass_matrix_that_is_stated_to_be_regular_is_found(record, source):
    derived = dataclasses.replace(record.derivations[0], mass_matrix="regular")
    report = check_record(dataclasses.replace(record, derivations=(derived,)), source.description())
    disagreeing = {found.id for found in report.verdicts if found.verdict is Verdict.DISAGREES}
    assert {"inverse_mass_matrix", "redundant_constraints"} <= disagreeing


def test_closed_forms_with_a_large_inverse_are_there_if_they_come_out_short(massless_hooks):
    record = derived_record(massless_hooks)
    (derivation,) = record.derivations
    assert (derivation.mass_matrix, derivation.left_out) == ("supported", None)
    assert not check_record(record, massless_hooks.description()).disagreements
