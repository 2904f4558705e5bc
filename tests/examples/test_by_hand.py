"""The paper's example by hand, from the public steps alone: in batch, and its results."""

import json
import subprocess
from pathlib import Path

import pytest

from holonom.maxima import run_batch

BY_HAND = Path(__file__).parents[2] / "examples" / "paper" / "by_hand.mac"
NUMBERS = ("14", "2", "3a", "6", "7", "8", "10", "15", "16", "17", "18", "19")
# What must vanish: the paper's formulas, the dots and factors as they must be, less what the file has found.
S, W, BRACES = "(q1 + q2)", "(dot(q1) + dot(q2))", "((ddot(u) - u)*(q1 + q2) + 2*(dot(u) - u)*(dot(q1) + dot(q2)))"
TRUTHS = {
    "3a": "[A - ident(3), B, T0]",
    "6": "length(symbols)",
    "7": f"constraint_acceleration(f, q, [u]) - [ddot(q3) - u*(ddot(q1) + ddot(q2)) - 2*dot(u)*{W} - ddot(u)*{S}]",
    "8": f"lambdas - [{BRACES}/(1 + 2*u^2)]",
    "10": f"C - [-ddot(u)*{S} + u*{S} + 2*u*{W} - 2*dot(u)*{W}]",
    "15": "rhs(law) - u0*exp(t)",
    "16": f"F - [-q1 - q2 - u*{BRACES}/(1 + 2*u^2), -2*{W} - u*{BRACES}/(1 + 2*u^2), {BRACES}/(1 + 2*u^2)]",
    "17": "initial_accelerations(F, q, [u = u0 + t])"
    " - subst(initial_state(q), subst([u = u0, dot(u) = 1, ddot(u) = 0], F))",
    "18": "at_zero(initial_series(F, q, [u = u0 + t], 3), 2) - initial_accelerations(F, q, [u = u0 + t])",
    "19": "map(rhs, determined_initial_values(f, q, [u = u0 + t], [q3]))"
    f" - subst(initial_state(q), [u0*{S}, {S} + u0*{W}])",
}


def test_every_step_is_printed():
    command = ["maxima", "--init=/dev/null", "-b", str(BY_HAND)]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120, check=True)
    assert all(f"({number}) " in done.stdout for number in NUMBERS)
    assert "error" not in done.stdout


@pytest.fixture(scope="module")
def remainders(tmp_path_factory) -> dict[str, str]:
    """Return what is left of each difference, as text."""
    job = tmp_path_factory.mktemp("by_hand") / "job.mac"
    found = ", ".join(f"string(flatten(ratsimp([{difference}])))" for difference in TRUTHS.values())
    job.write_text(f"""load("{BY_HAND}")$
at_zero(X, order) := subst(t = 0, diff(X, t, order))$
remainders_by_hand : [{found}]$
open_namespace()$
write_found(file) := write_json(json_list(lambda([x], x), remainders_by_hand), file)$
""")
    return dict(zip(TRUTHS, json.loads(run_batch(job, "write_found")), strict=True))


@pytest.mark.parametrize("number", TRUTHS)
def test_a_step_has_the_truth_of_the_paper(remainders, number):
    assert set(remainders[number]) <= set("[0,] matrix()"), remainders[number]
