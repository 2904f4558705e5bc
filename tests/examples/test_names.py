"""A scene may use any name that the library uses for itself, and loading the library takes nothing of Maxima's away."""

import json
import re
from pathlib import Path

import pytest

from holonom import maxima
from holonom.crosscheck.check import check_record
from holonom.maxima import run_batch
from holonom.record import derived_record, read_record
from holonom.source import describe

HOLONOM = 'load("holonom.mac")$'

BALL = """
ball : particle(mass, [east, north])$
system : holonomic_system(
  controls = [reach], parameters = [mass, weight],
  assembly(moving = ball, distance_joint(ball, [0, 0], reach), falling = uniform_gravity(weight/mass, ball)),
  forces = [drag = [-dot(east)/9, -dot(north)/9]])$
fling : holonomic_scene(system, control_law = [reach = 1 + t/10], parameter_values = [mass = 2, weight = 981/50],
  initial_state = [east = 3/5, north = -4/5, dot(east) = 0], time_span = [0, 3])$
pulled : holonomic_scene(system, prescribed_reactions = [lambda1 = -t], parameter_values = [mass = 2, weight = 981/50],
  initial_state = [east = 3/5, north = -4/5, dot(east) = 0, reach = 1, dot(reach) = 0])$
"""

WRITERS = (
    "write_record",
    "lambda([it], write_program(it, 'fling, 'direct))",
    "lambda([it], write_program(it, 'pulled, 'orthogonal))",
    "lambda([it], write_effects(it, 'fling, 'direct))",
    "lambda([it], write_motion_series(it, 'fling, 6, 'exact, false))",
    "lambda([it], write_motion_problem(it, 'pulled, 'direct, 16, [], ['response]))",
    "lambda([it], write_free_motion(it, 'fling, 6))",
)

# What a user's name may stand for: a function of any arguments, an indexed name, a value.
TAKEN = """
{name}([anything]) := error("this is the user's", '{name})$
{name}[i] := error("this is the user's", '{name})$
{name} : "the user's value of {name}"$
"""

# Every function of Maxima's, in its own language or in Lisp's, and every variable with its value.
LEDGER = """
(in-package :maxima)
(defvar *ledger* nil)
(defun meaning (name)
  (cond ((special-operator-p name) nil)
        ((macro-function name))
        ((fboundp name) (symbol-function name))
        (t (mget name 'mexpr))))
(defun $open_ledger ()
  (do-symbols (name :maxima '$done)
    (push (list name (meaning name) (and (boundp name) (atom (symbol-value name)) (list (symbol-value name))))
          *ledger*)))
(defun $changed_names ()
  (cons '(mlist)
        (loop for (name meaning value) in *ledger*
              unless (and (or (null meaning) (eq meaning (meaning name)))
                          (or (null value) (not (maxima-name-p name)) (equal (car value) (symbol-value name))))
              collect (print-invert-case name))))
"""
DELIBERATELY = {
    "$diff",  # notes what a scene differentiates by t (partial_rates.lisp)
    "make-number",  # remembers what decimals are read from (numbers.lisp)
}
ON_GCL = {"print-invert-case"}  # the same text, sooner; and of names beyond ASCII, which GCL 2.7.1 misprints


@pytest.fixture(scope="module")
def internal_names(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """The names that the library keeps to itself, errata and all."""
    file = tmp_path_factory.mktemp("names") / "names.mac"
    file.write_text(
        f'{HOLONOM}\nload("paper/errata.mac")$\nopen_namespace()$\n'
        "write_names(file) := write_json(json_list(string, internal_names()), file)$\n"
    )
    return [name for name in json.loads(run_batch(file, "write_names")) if not re.search(rf"\b{name}\b", BALL)]


# Writes several documents into one file, one after the other.
TOGETHER = """lambda([its_file], block([its_stream : openw(its_file), its_part, its_line],
  for its_writer in [{writers}] do (
    apply(its_writer, ["part"]), its_part : openr("part"),
    while stringp(its_line : readline(its_part)) do printf(its_stream, "~a~%", its_line),
    close(its_part)),
  close(its_stream)))"""


def documents(text: str, directory: Path, writers: tuple[str, ...]) -> list[object]:
    """Documents about a scene file, its text and the library in one Maxima."""
    file = directory / "scene.mac"
    file.write_text(text)
    written = run_batch(file, TOGETHER.format(writers=", ".join(writers)))
    found, decoder = [], json.JSONDecoder()
    while written := written.lstrip():
        document, end = decoder.raw_decode(written)
        found, written = [*found, document], written[end:]
    assert len(found) == len(writers)
    return found


@pytest.mark.long
@pytest.mark.parametrize(("order", "writers"), [("before", WRITERS[:3]), ("before", WRITERS[3:]), ("after", WRITERS)])
def test_a_scene_may_define_every_name_of_the_library(order, writers, internal_names: list[str], tmp_path: Path):
    taken = "".join(TAKEN.format(name=name) for name in internal_names)
    scene = f"{taken}{HOLONOM}{BALL}" if order == "before" else f"{HOLONOM}{taken}{BALL}"
    assert len(internal_names) > 700
    assert documents(scene, tmp_path, writers) == documents(HOLONOM + BALL, tmp_path, writers)


@pytest.mark.parametrize("flag", ["obase : 8", "modulus : 7", "exponentialize : true", "listarith : false"])
def test_a_flag_of_maximas_does_not_change_the_motion(flag: str, tmp_path: Path):
    # the motion was another one, with exit status 0
    ours, theirs = (documents(HOLONOM + first + BALL, tmp_path, WRITERS[4:6]) for first in ("", f"{flag}$\n"))
    assert ours == theirs


def test_numbers_under_numer_are_exact_in_the_motion(tmp_path: Path):
    # numer : true makes decimals of what the scene writes, and nothing of what the library computes
    scene = BALL.replace("1 + t/10", "1 + t/8").replace("981/50", "39/2").replace("3/5", "0").replace("-4/5", "-1")
    scene = re.sub(r"-dot\((\w+)\)/9", r"-dot(\1)/8", scene)
    ours, theirs = (documents(HOLONOM + first + scene, tmp_path, WRITERS[4:5]) for first in ("", "numer : true$\n"))
    assert ours == theirs


@pytest.mark.parametrize(
    "letters",
    [
        {"east": "A", "north": "lambda", "reach": "T0", "mass": "christoffel", "weight": "Lambda", "fling": "J"},
        # Maxima reads them as symbols of its own, as `mgo`, which no document could hold
        {"east": "go", "north": "box", "reach": "return", "mass": "block", "ball": "factorial", "fling": "labox"},
    ],
)
def test_a_scene_may_call_its_coordinates_by_letters_of_the_paper_and_of_maxima(letters, tmp_path: Path):
    scene = BALL
    for word, letter in letters.items():
        scene = re.sub(rf"\b{word}\b", letter, scene)
    (file := tmp_path / "scene.mac").write_text(HOLONOM + scene)
    record = derived_record(file)
    report = check_record(record, describe(file))
    assert set(record.system.coordinates) == {letters["east"], letters["north"]}
    assert report.verdicts
    assert report.disagreements == 0


def test_a_function_of_the_users_is_the_users(tmp_path: Path):
    # gradient(V) was taken for the library's own, and three equations disagreed
    (file := tmp_path / "scene.mac").write_text(
        f"""{HOLONOM}
gradient(V) := [diff(V, x), diff(V, y)]$
field : g*y + k*(x^2 + y^2)/2$
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [m, g, k],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, forces = [field = -gradient(field)], constraints = [x^2 + y^2 - u^2])$
""".replace("[field =", "[pull =")
    )
    report = check_record(read_record(run_batch(file, "write_record")), describe(file))
    assert report.verdicts
    assert report.disagreements == 0


def test_loading_the_library_changes_nothing_of_maximas(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(maxima, "preloaded_image", lambda *_: None)  # it is to be loaded behind the ledger
    (tmp_path / "ledger.lisp").write_text(LEDGER)
    (file := tmp_path / "load.mac").write_text(
        f'load("{tmp_path}/ledger.lisp")$\nopen_ledger()$\n{HOLONOM}\nload("paper/errata.mac")$\n'
        "changed : changed_names()$\nopen_namespace()$\n"
        "lisp : ?lisp\\-implementation\\-type()$\n"
        "write_changed(file) := write_json(json_list(lambda([x], x), cons(lisp, changed)), file)$\n"
    )
    lisp, *changed = json.loads(run_batch(file, "write_changed"))
    assert set(changed) - DELIBERATELY == (ON_GCL if "GCL" in lisp else set())


def test_eliminate_is_maximas_own(tmp_path: Path):
    (file := tmp_path / "load.mac").write_text(
        f"{HOLONOM}\nwrite_eliminated(file) := write_json(string(eliminate([x + y = 1, x - y = 3], [x])), file)$\n"
    )
    assert json.loads(run_batch(file, "write_eliminated")) in ("[-2*(y+1)]", "[-(2*(y+1))]")


def test_the_library_is_not_in_the_users_lists(tmp_path: Path):
    # kill(all) took the library away, and with it all that a scene could still ask
    (file := tmp_path / "load.mac").write_text(
        f"{HOLONOM}\nmade : [functions, values, structures]$\nbefore : string(made)$\nkill(all)$\n{BALL}\n"
    )
    assert json.loads(run_batch(file, "write_record"))["system"]["coordinates"] == ["east", "north"]
