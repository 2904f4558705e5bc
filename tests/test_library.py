"""The Maxima library as a whole: one namespace."""

import re
from collections import Counter

from holonom.maxima import LIBRARY, run_batch
from holonom.preloaded import JOBS

DEFINITION = re.compile(r"^(\w+)\([^()]*\)\s*:=", re.MULTILINE)
LISP_DEFINITION = re.compile(r"^\(def(?:un|macro) (\S+)", re.MULTILINE)


def test_no_function_is_defined_twice():
    maxima = "\n".join(file.read_text() for file in LIBRARY.rglob("*.mac"))
    lisp = "\n".join(file.read_text() for file in (*LIBRARY.rglob("*.lisp"), *JOBS))  # they meet in one Lisp
    names = [*(f"${name}" for name in DEFINITION.findall(maxima)), *LISP_DEFINITION.findall(lisp)]
    assert [name for name, times in Counter(names).items() if times > 1] == []


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
