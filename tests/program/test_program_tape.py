"""Assignments of a program that is being written: new names, each operation once."""

import pytest

from holonom.program.motion_program import Name, Operation
from holonom.program.tape import Tape


@pytest.mark.parametrize("taken", [set(), {"v1"}, {"v", "vv2", "x"}, {"v3", "vv1", "vvv"}])
def test_no_assignment_has_a_name_that_is_taken(taken):
    tape, x = Tape(taken), Name("x")
    values = [tape(operation, x) for operation in (Operation.SIN, Operation.COS, Operation.EXP)]
    assert [name.text for name in values] == [name for name, _ in tape.assignments]
    assert taken.isdisjoint(name for name, _ in tape.assignments)
    assert tape(Operation.SIN, x) == values[0]
