"""Headless runs of Maxima: whatever a file does, one clear sentence in bounded time, with the place if known."""

import re
import subprocess
from dataclasses import replace

import pytest
from particle import PARTICLE
from rtests import RtestFailed, count_statements, run_rtest
from shell import SHELL

from holonom.documents import ask
from holonom.failures import ErrorKind, HolonomError
from holonom.formats import Document
from holonom.maxima import LIBRARY, run_batch
from holonom.sandbox import Limits

LONG = Limits(seconds=100, memory_mib=512, output_mib=1)


def failure_of(file, limits=LONG) -> HolonomError:
    with pytest.raises(HolonomError) as raised:
        ask(Document.RECORD, file, limits=limits)
    return raised.value


def test_a_scene_that_was_copied_away_from_beside_the_library_was_refused(write_scene):
    beside = 'load(sconcat(pathname_directory(load_pathname), "../maxima/holonom.mac"))$'
    file = write_scene(PARTICLE.replace('load("holonom.mac")$', beside))
    assert "record" in ask(Document.RECORD, file)


@pytest.mark.parametrize(
    ("text", "line", "failure", "detail"),
    [
        ("x : 1$\n\nintegrate(exp(-a*y), y, 0, inf)$", 3, ErrorKind.QUESTION, "Is a positive, negative or zero?"),
        ('read("asked", x^2)$', 1, ErrorKind.QUESTION, "asked x^2"),
        ("x : 1$\ny :\n  1/0$", 2, ErrorKind.REFUSED, "expt: undefined: 0 to a negative exponent."),
        ('/* a /* nested */ one */\nerror("lost:", x^2 + y/z)$', 2, ErrorKind.REFUSED, "lost: y/z+x^2"),
        ('load("nowhere.mac")$', 1, ErrorKind.REFUSED, "file_search1: nowhere.mac not found"),
        ("f(x) := x$\nf(1, 2)$", 2, ErrorKind.REFUSED, "Too many arguments"),
        ("x : 1$\ny : 2 +* 3$", 2, ErrorKind.SYNTAX, "* is not a prefix operator"),
        ("y compare z$", 1, ErrorKind.SYNTAX, "compare is not an infix operator"),
        ("x : 1$\ny : (2", 2, ErrorKind.SYNTAX, "end of file"),
        ('x : 1$\ny : "unclosed', 2, ErrorKind.SYNTAX, "end of file"),
        ("x : 1$\n/* a /* b */\ny : 2$ /* c */", 2, ErrorKind.COMMENT_NOT_CLOSED, ""),
        ("f(x) := 1 + f(x)$\nf(1)$", 2, ErrorKind.LISP_ERROR, "overflow"),
        ("?car(1, 2)$", 1, ErrorKind.LISP_ERROR, "arguments"),
        (r'?rat\-error("quotient is not exact")$', 1, ErrorKind.REFUSED, "quotient is not exact"),
    ],
)
def test_a_statement_that_fails_is_found(text, line, failure, detail, write_scene):
    file = write_scene(text)
    error = failure_of(file)
    assert error.kind is failure
    assert error.place == f"{file}:{line}"
    assert detail in error.detail
    assert error.refusal is None
    assert "\n" not in str(error)


@pytest.mark.parametrize(
    ("text", "failure"),
    [
        # GCL collects garbage until the clock runs out where it cannot have the memory it wants.
        pytest.param(
            "hog : []$ for i do hog : cons(1.5*i, hog)$",
            {ErrorKind.TOO_LARGE, ErrorKind.TOO_LONG},
            marks=pytest.mark.long,
        ),
        ('for i do print("so it goes on, and on, and on")$', {ErrorKind.TOO_MUCH_TEXT}),
        ("quit()$", {ErrorKind.ENDED_EARLY}),
        (f'{SHELL} in_a_shell("kill -9 $PPID")$', {ErrorKind.KILLED}),
        ("x : 1$", {ErrorKind.NOTHING_WRITTEN}),
        ("", {ErrorKind.NOTHING_WRITTEN}),
    ],
)
def test_a_file_that_ends_badly_is_named(text, failure, write_scene):
    file = write_scene(text)
    error = failure_of(file, LONG)
    assert error.kind in failure
    assert str(error).startswith(f"{file}: ")


@pytest.mark.parametrize("text", ["for i do 1$", f'{SHELL} in_a_shell("sleep 60")$'])
def test_a_file_that_never_ends_is_ended(text, write_scene):
    assert failure_of(write_scene(text), replace(LONG, seconds=1)).kind is ErrorKind.TOO_LONG


def test_a_syntax_error_in_a_loaded_file_is_found_there(write_scene, tmp_path):
    part = tmp_path / "part.mac"
    part.write_text("x : 1$\n\ny : ]$\n")
    assert failure_of(write_scene(f'load("{part}")$')).place == f"{part}:3"


def test_an_error_is_caught_by_the_file_itself(write_scene):
    error = failure_of(write_scene("errcatch(1/0)$ x : 1$"))
    assert error.kind is ErrorKind.NOTHING_WRITTEN


def test_a_lisp_error_without_a_message_ended_in_an_empty_sentence(write_scene):
    error = failure_of(write_scene('?error("")$'))
    assert error.kind is ErrorKind.LISP_ERROR
    assert error.detail


def test_a_refusal_has_its_id_with_its_place(write_scene):
    file = write_scene('load("holonom.mac")$\ndot(x + y)$')
    error = failure_of(file)
    assert (error.kind, error.refusal, error.place) == (ErrorKind.REFUSED, "dot_of_expression", f"{file}:2")


def test_an_error_after_a_refusal_that_was_caught_has_no_id(write_scene):
    assert failure_of(write_scene('load("holonom.mac")$ errcatch(dot(x + y))$ 1/0$')).refusal is None


def at_prompt(statements):
    """Return what Maxima prints of statements behind the load of the library."""
    command = ["maxima", "--very-quiet", "--init=/dev/null"]
    loaded = f'--batch-string=display2d : false$ load("{LIBRARY}/holonom.mac")$ {statements}'
    done = subprocess.run([*command, loaded], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=100)
    return done.stdout + done.stderr


def test_the_prompt_shows_the_sentence_without_the_id():
    printed = at_prompt("dot(x + y);")
    assert "x+y" in printed
    assert not re.search("refuse|dot_of_expression", printed)


def test_steps_at_the_prompt_are_independent_of_the_session():
    """depends(x, t) counted motions twice, and a killed step stayed gone; Groebner bases have a structure TERM, too."""
    printed = at_prompt(
        "depends([x, u], t)$ constraint_acceleration([x - u], [x], [u]); is(diff(x, t) # 0); "
        f'accelerations(x) := x^2$ kill(accelerations)$ load("{LIBRARY}/holonom.mac")$ '
        "accelerations(matrix([1/m]), [m*g], matrix(), []); total(list) := lmax(list)$ load(grobner)$ "
        "system : holonomic_system(coordinates = [x], controls = [u], parameters = [m], "
        "kinetic_energy = m*dot(x)^2/2, constraints = [x^2 - u])$ constraint_acceleration([x^2 - u], [x], [u]); "
        "derive(system)@multipliers;"
    ).replace("\\", "")
    expected = [
        "[ddot(x)-ddot(u)]",
        "true",
        "[g]",
        "[2*ddot(x)*x+2*dot(x)^2-ddot(u)]",
        "[((ddot(u)-2*dot(x)^2)*m)/(4*x^2)]",
    ]
    assert [line for line in printed.splitlines() if line in expected] == expected


def test_a_file_without_a_system_is_refused(write_scene):
    assert failure_of(write_scene('load("holonom.mac")$')).refusal == "no_system"


def test_missing_and_unreadable_files(tmp_path):
    assert failure_of(tmp_path / "nowhere.mac").kind is ErrorKind.FILE_MISSING
    assert failure_of(tmp_path).kind is ErrorKind.FILE_UNREADABLE


def test_maxima_not_installed(particle_scene, monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    assert failure_of(particle_scene).kind is ErrorKind.MAXIMA_MISSING


def test_init_files_are_not_read(write_scene, tmp_path, monkeypatch):
    (tmp_path / "maxima-init.mac").write_text('error("read")$')
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MAXIMA_USERDIR", str(tmp_path))
    assert failure_of(write_scene("x : 1$")).kind is ErrorKind.NOTHING_WRITTEN


def test_the_command_given_repeats_the_failure_with_maxima_alone(write_scene):
    error = failure_of(write_scene('x : 1$\nerror("lost:", m)$'))
    done = subprocess.run(error.command, shell=True, capture_output=True, text=True, timeout=100)
    assert "lost: m" in done.stdout + done.stderr  # newer versions of Maxima have errors on the latter


def test_the_last_lines_come_with_the_error(write_scene):
    assert "printed" in failure_of(write_scene('print("printed")$ error("lost")$')).last_lines[-1]


def test_a_name_with_blanks_quotes_and_accents(tmp_path):
    directory = tmp_path / 'a "quoted" é'
    directory.mkdir()
    file = directory / "b c.mac"
    file.write_text('write(name) := with_stdout(name, print("written"))$')
    assert run_batch(file, "write") == "written \n"


def test_an_error_in_a_file_with_a_line_end_in_its_name_is_found(tmp_path):
    file = tmp_path / "two\nlines.mac"
    file.write_text("x : 1$\nfoo(")
    failure = failure_of(file)
    assert (failure.kind, failure.place) == (ErrorKind.SYNTAX, f"{file}:2")


def test_a_scene_finds_the_library(particle_record):
    assert '"holonom-record"' in particle_record


@pytest.mark.parametrize(
    ("text", "statements"),
    [
        ("", 0),
        ("x : 1$ y : 2;", 2),
        ("/* x; /* y$ */ z; */ x$", 1),
        ('print("a; b$ \\" ;")$ /* "unclosed; */ y;', 2),
        ("x\\$y : 1$", 1),
    ],
)
def test_statements_are_counted(text, statements):
    assert count_statements(text) == statements


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("1 + 1;\n2$\n1 + 2;\n4$\n", RtestFailed),
        ("1 + 1;\n2$\n1 +* 2;\n3$\n2;\n2$\n", HolonomError),
        ("1 + 1;\n2$\n1 + 2;\n", RtestFailed),
    ],
)
def test_an_rtest_file_that_does_not_pass_whole_is_refused(text, error, write_scene):
    with pytest.raises(error):
        run_rtest(write_scene(text))


def test_an_rtest_file_that_passes_is_counted_and_nothing_left_beside_it(write_scene):
    file = write_scene("1 + 1;\n2$\n1 + 2;\n3$\n")
    assert run_rtest(file) == 2
    assert list(file.parent.iterdir()) == [file]
