"""The Maxima library as a whole: one namespace."""

import json
import re
from collections import Counter
from pathlib import Path

import pytest

from holonom.maxima import LIBRARY, run_batch
from holonom.preloaded import JOBS

DEFINITION = re.compile(r"^(\w+)\([^()]*\)\s*:=", re.MULTILINE)
LISP_DEFINITION = re.compile(r"^\(def(?:un|macro) (\S+)", re.MULTILINE)


def test_no_function_is_defined_twice():
    maxima = "\n".join(file.read_text() for file in LIBRARY.rglob("*.mac"))
    lisp = "\n".join(file.read_text() for file in (*LIBRARY.rglob("*.lisp"), *JOBS))  # they meet in one Lisp
    names = [*(f"${name}" for name in DEFINITION.findall(maxima)), *LISP_DEFINITION.findall(lisp)]
    assert [name for name, times in Counter(names).items() if times > 1] == []


def sources() -> list[Path]:
    return sorted(file for kind in ("mac", "lisp") for file in LIBRARY.rglob(f"*.{kind}"))


def without_comments(file: Path) -> str:
    comment = r"/\*.*?\*/" if file.suffix == ".mac" else r"^\s*;[^\n]*"
    return re.sub(comment, "", file.read_text(), flags=re.DOTALL | re.MULTILINE)


def test_no_line_is_over_120_characters():
    lines = [(file.name, line) for file in sources() for line in file.read_text().splitlines()]
    assert [(name, line) for name, line in lines if len(line) > 120] == []


def test_no_function_is_over_20_lines():
    long = []
    for file in sources():
        ends, begins = (r"\$\n", r"\w+\([^()]*\)\s*:=") if file.suffix == ".mac" else (r"\n(?=\()", r"\(def(un|macro) ")
        for statement in re.split(ends, without_comments(file)):
            lines = [line for line in statement.strip().splitlines() if line.strip()]
            if re.match(begins, statement.strip()) and len(lines) > 20:
                long.append((file.name, lines[0]))
    assert long == []


def layers() -> dict[str, int]:
    """The layer of each file of the load list, by the headings there."""
    _, *groups = (LIBRARY / "holonom.mac").read_text().split("/* ---- ")
    return {file: layer for layer, group in enumerate(groups) for file in re.findall(r'"([\w/]+\.\w+)"', group)}


def called_names(file: Path) -> set[str]:
    """The functions that a file calls or hands on to others that call them, spelt as Lisp does."""
    if file.suffix == ".lisp":
        code = re.sub(r'"(?:\\.|[^"\\])*"|;[^\n]*', "", file.read_text())
        return set(re.findall(r"(?:(?<!\()\(|#'|mfuncall ')([^\s()'`,\"]+)", code))
    code = re.sub(r'/\*.*?\*/|"(?:\\.|[^"\\])*"', "", file.read_text(), flags=re.DOTALL)
    called = re.findall(r"(?<![\w%'@])(\w+)(?=\()|\((?<!refuse\()'(\w+)", code)
    return {f"${name}" for names in called for name in names if name}


def test_no_layer_calls_one_above_it():
    layer = layers()
    home = {f"${name}": file for file in layer for name in DEFINITION.findall((LIBRARY / file).read_text())}
    home |= {name: file for file in layer for name in LISP_DEFINITION.findall((LIBRARY / file).read_text())}
    upwards = [
        f"{file} calls {name} of {home[name]}"
        for file in layer
        for name in sorted(called_names(LIBRARY / file) & home.keys())
        if layer[home[name]] > layer[file]
    ]
    assert upwards == []


ONE_HOME = {
    r"share_of_disagreement": "algebra/zero.mac",  # numbers of two precisions, compared
    r"(?<!define_variable\()trial_seed|(?<![\w%])random\(": "algebra/trial_points.mac",
    r"(?:%kernels_met|%kernel_\w+|%branch_points|%two_sided) :": "algebra/kernels.mac",
    r'"d\^2f/dt\^2"': "derivation/constraint_acceleration.mac",  # the terms of (7)
    r'"dT0/dq_s"': "derivation/expanded_equations.mac",  # those of (3)
}


@pytest.mark.parametrize(("mechanism", "home"), ONE_HOME.items(), ids=ONE_HOME.values())
def test_a_mechanism_of_the_algebra_has_one_home(mechanism, home):
    files = {file for file in layers() if re.search(mechanism, without_comments(LIBRARY / file))}
    assert files - {"algebra/tolerances.mac"} == {home}


def test_tolerances_have_names():
    small = re.compile(r"\b\d+b-\d+|1/10\^\d+|10b0\^\(-\d+\)|10\^\(-\d+\)")
    unnamed = [
        (file, line)
        for file in layers()
        if file.endswith(".mac") and file != "algebra/tolerances.mac"
        for line in without_comments(LIBRARY / file).splitlines()
        if small.search(line) and not line.startswith("define_variable(")
    ]
    assert unnamed == []


def test_every_file_of_the_library_has_its_place_in_the_load_list():
    files = {file.relative_to(LIBRARY).as_posix() for kind in ("mac", "lisp") for file in LIBRARY.rglob(f"*.{kind}")}
    apart = {"holonom.mac", "namespace.lisp", "help.lisp"}
    assert {file for file in files - apart if not file.startswith("paper/")} == set(layers())


def test_a_header_states_arguments_and_results():
    """Takes and Returns, or each function with its arguments. The other files are constants and load lists."""
    apart = {"algebra/tolerances.mac", "holonom.mac", "paper/errata.mac", "paper/paper.mac"}
    lacking = set()
    for file in LIBRARY.rglob("*.mac"):
        header, code = file.read_text(encoding="utf-8").split("*/", 1)
        functions = re.findall(r"^(\w+)\(", code, re.MULTILINE)
        named = any(re.search(rf"\b{name}\(", header) for name in functions)
        if not named and not re.search(r"^ +Returns: |returns", header, re.MULTILINE):
            lacking.add(file.relative_to(LIBRARY).as_posix())
    assert lacking == apart


@pytest.mark.parametrize("file", sorted(LIBRARY.rglob("*.mac")), ids=lambda file: str(file.relative_to(LIBRARY)))
def test_a_header_states_the_errors_that_the_file_raises(file):
    header, code = file.read_text(encoding="utf-8").split("*/", 1)
    assert ("refuse('" not in code) or re.search(r"^ +Errors *: ", header, re.MULTILINE)


def test_the_steps_take_lists_and_matrices_and_no_structures():
    for file in sorted((LIBRARY / "derivation").glob("*.mac")):
        code = re.sub(r"/\*.*?\*/|\"[^\"]*\"", "", file.read_text(), flags=re.DOTALL)
        assert not re.findall(r"@|\bsys\b|\bscene\b|\bdefstruct\b", code), file.name


def test_the_files_of_the_paper_do_not_have_the_library_read_anew(tmp_path):
    job = tmp_path / "job.mac"
    job.write_text(f"""
        load("{LIBRARY}/holonom.mac")$
        load("{LIBRARY}/paper/errata.mac")$
        open_namespace()$
        simplest(expr) := "known by its mark"$
        load("{LIBRARY}/holonom.mac")$
        load("{LIBRARY}/paper/errata.mac")$
        write_marked(file) := write_json(json_list(lambda([x], x), [simplest(0)]), file)$
    """)
    assert "known by its mark" in run_batch(job, "write_marked")


BINDING = """
its_function(its_a, [its_b]) := block([its_c, its_d : 1, [its_e : 2]], its_g : its_free, [its_h, its_i] : [1, 2],
  its_j[1] : 2, for its_k thru 2 do 0, for its_l in its_free do 0, lambda([its_m, [its_n]], 0),
  makelist(its_free, its_o, its_free), sum(its_free, its_p, 1, 2), product(its_free, its_q, 1, 2),
  lsum(its_free, its_r, its_free), create_list(its_free, its_s, its_free, its_t, its_free))$
define(its_u(its_v), its_free)$
its_w(its_x) ::= its_free$
defstruct(its_y(its_field))$
"""


def test_what_the_library_binds_is_private_and_what_it_only_reads_is_not(tmp_path):
    (tmp_path / "binding.mac").write_text(BINDING)
    job = tmp_path / "job.mac"
    job.write_text(f"""
        load("{LIBRARY}/holonom.mac")$
        load_library("{tmp_path}/", ["binding.mac"])$
        open_namespace()$
        write_private(file) := write_json(json_list(string, sublist(internal_names(),
          lambda([name], is(ssearch("its_", string(name)) = 1)))), file)$
    """)
    names = {*re.findall(r"its_\w+", BINDING)} - {"its_free", "its_field"}
    assert {*json.loads(run_batch(job, "write_private"))} == names
