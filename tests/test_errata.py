"""The paper as printed: the misprints found, no others, and no change to a right equation unnoticed."""

import difflib
import json
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from holonom.errata import PRINTED, PrintedEquation
from holonom.maxima import run_batch

MISPRINTS = [
    ("7", "constraints, differentiated twice"),
    ("8", "equations for the multipliers"),
    ("10", "condition of free motion"),
    ("", "equation of motion of q2"),
    ("", "multiplier"),
    ("16", "acceleration of q1"),
    ("16", "acceleration of q2"),
    ("16", "acceleration of q3"),
    ("17", "initial acceleration of q3"),
]

# One change each: what stands there and what is put in its place.
SLIPS = [
    (r"\bdot\(", "ddot("),
    (r"\bdot\(", "("),
    (r"\bddot\(", "dot("),
    (r"\bdddot\(", "ddot("),
    (r" \+ ", " - "),
    (r" - ", " + "),
    (r"(?<=\()-", ""),
    (r"\b2\b", "3"),
    (r"\b1\b", "2"),
    (r"\b2\*", ""),
    (r"(?<= [+=-] )(?=\w)(?!0)", "2*"),
    (r"(?<!dot\()\bu0?\b(?!\[)", "1"),  # dot(1) is refused
    (r"\bq(?=[1-3]\b)", "u"),
    *[(rf"(?<=[\[,]){index}(?=[\],])", other) for index, other in zip("sklm", "klms", strict=True)],
    *[(rf"\[{index}\]", f"[{other}]") for index, other in [("rho", "sigma"), ("sigma", "rho")]],
    *[(rf"\[{index}\]", f"[{other}]") for index, other in [("beta", "gamma"), ("gamma", "beta")]],
]

# Compares each of the texts with the derived equation at its place; writes the places in `texts` that agree.
COMPARISON = """
load("{printed}")$
open_namespace()$
derived : append(general_equations(), as_the_library_reads(example_equations(system, initial_motion_scene)))$
texts : [{texts}]$
agreeing(texts) := sublist(makelist(x, x, length(texts)), lambda([x],
  vanishing(deviation_of(parts_of(second(texts[x])),
                         derived_counterpart(printed_equations[first(texts[x])], derived)))))$
write_agreeing(file) := write_json(json_list(lambda([x], x), agreeing(texts)), file)$
"""


def mended(equation: PrintedEquation) -> str:
    return equation.printed if equation.agrees else equation.corrected


def slips_between(printed: str, corrected: str) -> list[tuple[str, str]]:
    """The words that differ, as printed and as they must be."""
    words = [re.findall(r"\w+|[^\w\s]", text) for text in (printed, corrected)]
    changes = difflib.SequenceMatcher(None, *words, autojunk=False).get_opcodes()
    return [(" ".join(words[0][a:b]), " ".join(words[1][c:d])) for kind, a, b, c, d in changes if kind != "equal"]


def one_slip_away(text: str) -> Iterator[str]:
    """All texts that differ from an equation by one of the slips, at one place."""
    for pattern, replacement in SLIPS:
        for match in re.finditer(pattern, text):
            yield text[: match.start()] + replacement + text[match.end() :]


def agreeing(texts: list[tuple[int, str]], directory: Path) -> set[int]:
    """Places in `texts`, pairs of a row of the errata (from 0) and a text for it, where the text agrees."""
    job = directory / "comparison.mac"
    listed = ",\n".join(f'[{row + 1}, "{text}"]' for row, text in texts)
    job.write_text(COMPARISON.format(printed=PRINTED, texts=listed))
    return {place - 1 for place in json.loads(run_batch(job, "write_agreeing"))}


def test_finds_the_misprints_and_no_others(printed_equations):
    assert [(e.number, e.name) for e in printed_equations if not e.agrees] == MISPRINTS


@pytest.mark.long
def test_the_table_of_the_prompt_has_a_row_for_each_equation(printed_equations):
    command = ["maxima", "--very-quiet", "--init=/dev/null", f"--batch={PRINTED}"]
    text = subprocess.run(command, capture_output=True, text=True, check=True, stdin=subprocess.DEVNULL).stdout
    rows = [(e.number, e.name, "agrees" if e.agrees else "differs") for e in printed_equations]
    assert re.findall(r"^(?:\((\w+)\))? +(\S.*?) +(agrees|differs)$", text, re.MULTILINE) == rows


def test_each_misprint_is_the_slip_that_a_reader_of_the_print_sees(printed_equations):
    # printed -> right; a change in the transcription of a misprinted equation shows here
    undotted, unfactored, overdotted = ("dot", "ddot"), ("", "2 *"), ("ddot", "dot")
    renamed = [("alpha", "sigma")] * 2  # alpha is the number of controls
    assert [slips_between(e.printed, e.corrected) for e in printed_equations if not e.agrees] == [
        [*renamed, undotted, undotted],  # (7): accelerations of q and u
        [unfactored, *renamed, undotted],  # (8): the mixed term of q and u; acceleration of u
        [unfactored, *renamed, undotted],  # (10): the same
        [("u", "2")],  # equation of motion of q2
        [overdotted],  # multiplier
        [overdotted],  # (16): each of the three
        [overdotted],
        [overdotted],
        [("u0", "1")],  # (17): the third
    ]


def test_covers_every_number(printed_equations):
    assert {e.number for e in printed_equations} == {"", *map(str, range(1, 20))}


def test_a_misprint_has_a_difference_and_a_correction_and_nothing_else_has(printed_equations):
    for equation in printed_equations:
        assert (equation.difference is None) == (equation.corrected is None) == equation.agrees
        assert equation.difference != "0"
        assert equation.corrected != equation.printed


def test_the_corrected_equations_agree_and_the_printed_ones_do_not(printed_equations, tmp_path):
    misprints = [(row, equation) for row, equation in enumerate(printed_equations) if not equation.agrees]
    corrected = [(row, equation.corrected) for row, equation in misprints]
    printed = [(row, equation.printed) for row, equation in misprints]
    assert agreeing(corrected + printed, tmp_path) == set(range(len(corrected)))


def test_no_slip_goes_unnoticed(printed_equations, tmp_path):
    slips = [(row, slip) for row, equation in enumerate(printed_equations) for slip in one_slip_away(mended(equation))]
    assert len(slips) > 500
    assert [slips[place] for place in agreeing(slips, tmp_path)] == []


def leaves(tree) -> list[str]:
    return [leaf for part in tree[1:] for leaf in leaves(part)] if isinstance(tree, list) else [str(tree)]


def test_the_trees_keep_every_letter_in_its_place(printed_equations):
    functions = {"det", "dot", "ddot", "dddot", "partial", "rate", "exp"}
    for equation in printed_equations:
        for text, tree in [
            (equation.printed, equation.printed_tree),
            (equation.difference, equation.difference_tree),
            (equation.corrected, equation.corrected_tree),
        ]:
            assert (tree is None) == (text is None)
            if text is not None:
                assert leaves(tree) == [word for word in re.findall(r"\w+", text) if word not in functions]


def test_the_trees_keep_every_sign(printed_equations):
    def signs(tree) -> int:
        return (tree[0] == "Negate") + sum(map(signs, tree[1:])) if isinstance(tree, list) else 0

    for equation in printed_equations:
        assert signs(equation.printed_tree) == equation.printed.count("-")
