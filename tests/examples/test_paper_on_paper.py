"""The paper's example with Maxima alone: sections 1 to 4 on the terminal, in the paper's order."""

import re
import subprocess

import pytest

from holonom.files import shared

EXAMPLE = shared("examples") / "paper" / "paper.mac"


@pytest.fixture(scope="module")
def printed(tmp_path_factory) -> str:
    command = ["maxima", "--very-quiet", "--init=/dev/null", f"--batch={EXAMPLE}"]
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    done = subprocess.run(
        command, cwd=elsewhere, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120, check=True
    )
    return done.stdout[done.stdout.index("Sections 1 to 3") :]


def paragraph(printed: str, heading: str) -> str:
    """What stands under a heading."""
    return printed.partition(f"\n{heading}\n")[2].partition("\n\n")[0]


def test_numbers_come_in_the_order_of_the_paper(printed):
    numbers = [int(number) for number in re.findall(r"^\((\d+)\)  ", printed, re.MULTILINE)]
    assert numbers[:13] == list(range(1, 14))
    # (2) and (8) are named again where the paper puts (14) into them; (18) comes in symbols and in numbers
    assert numbers[13:] == [14, 15, 2, 8, 16, 17, 18, 19, 18]


def test_every_equation_has_its_reason(printed):
    for heading in re.findall(r"^\(\d+\)  .*$", printed, re.MULTILINE):
        assert paragraph(printed, heading).startswith("     ")
        assert paragraph(printed, heading).splitlines()[0].strip()


def test_no_line_is_broken_inside_a_word(printed):
    assert [line for line in printed.splitlines() if line.endswith("\\") and "Sections" not in line] == []


def test_the_first_task_is_answered(printed):
    assert paragraph(printed, "differential equations for the control").split("\n")[-2:] == [
        "         u - ddot(u) = 0 ",
        "         u - dot(u) = 0 ",
    ]
    assert re.search(r"t\s+u = %e  u0", paragraph(printed, "(15)  control of free motion"))
    assert "There is no other law under which every motion is free." in printed


def test_the_determinant_conditions_stand_where_they_are_needed(printed):
    assert "det(A[k,s]) # 0" in paragraph(printed, "condition on the mass matrix")
    product = re.search(r"det\((.*)\) # 0", paragraph(printed, "condition on the constraints"))[1]
    assert sorted(re.split(r"[* ]+", product)) == ["A_inverse[k,s]", "partial(f[beta],q[s])", "partial(f[gamma],q[k])"]


def test_the_accelerations_share_the_bracket_that_vanishes_on_a_free_motion(printed):
    bracket = "2 (dot(q2) + dot(q1)) (u - dot(u)) + (q2 + q1) (u - ddot(u))"
    assert f"{bracket} = 0" in paragraph(printed, "condition of free motion of the example")
    assert paragraph(printed, "(16)  accelerations").count(bracket) == 3
