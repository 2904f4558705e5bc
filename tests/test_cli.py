"""The commands: what they print, what they write, and the status they leave with."""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from importlib import metadata
from pathlib import Path
from string import Formatter

import click
import pytest
from click.testing import CliRunner
from confinement import without_notice
from particle import PARTICLE
from refusing import message_of

from holonom.cli import holonom as cli
from holonom.cli import run
from holonom.crosscheck.report import CheckResult, Verdict
from holonom.display.condition import condition_lines
from holonom.display.derivation import why_left_out
from holonom.failures import ErrorKind, HolonomError
from holonom.record import LARGEST_SIZE, LeftOut, read_record

HOLONOM = [sys.executable, "-m", "holonom"]
EXAMPLES = Path(__file__).parents[1] / "examples"
SHARE = [str(folder) for folder in Path("/usr/share/maxima").glob("*/share")]


def holonom(*arguments: str | Path, **options) -> subprocess.CompletedProcess[str]:
    command = [*HOLONOM, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, **options)
    done.stderr = without_notice(done.stderr)
    return done


def test_help_waits_for_no_library():
    assert "derive" in holonom("--help").stdout
    imported = [
        sys.executable,
        "-c",
        "import holonom.cli, sys; print({'sympy', 'rich', 'numpy', 'heyoka', 'holonom.maxima'} & sys.modules.keys())",
    ]
    assert subprocess.run(imported, capture_output=True, text=True, check=True).stdout == "set()\n"


COMMANDS = sorted(cli.commands.items())


@pytest.mark.parametrize(("name", "command"), COMMANDS, ids=[name for name, _ in COMMANDS])
def test_help_shows_a_whole_summary_and_examples_that_are_commands(name, command, monkeypatch):
    monkeypatch.chdir(EXAMPLES.parent)
    summary = command.help.splitlines()[0]
    assert len(summary) <= 45
    assert summary in cli.get_help(click.Context(cli, terminal_width=80))
    lines = command.get_help(click.Context(command, info_name=f"holonom {name}", terminal_width=80)).splitlines()
    assert [line for line in lines if len(line) > 80 or (line.endswith(("...", "…")) and "Usage:" not in line)] == []
    assert len(command.examples) >= (2 if command.params else 1)
    for example in command.examples:
        called, *arguments = shlex.split(example)
        assert called == name
        command.make_context(name, arguments)


def test_derive_prints_the_equations_by_their_numbers(particle_scene):
    done = holonom("derive", particle_scene)
    assert done.returncode == 0
    assert re.search('title *= "([^"]*)"', PARTICLE)[1] in done.stdout
    assert "(6) " in done.stdout
    assert "z = 0" in done.stdout
    assert "\x1b" not in done.stdout


def test_derive_writes_the_record_and_nothing_else(particle_scene, tmp_path):
    printed = json.loads(holonom("derive", particle_scene, "--json", "-").stdout)
    file = tmp_path / "record.json"
    assert holonom("derive", particle_scene, "--json", file).returncode == 0
    assert json.loads(file.read_text()) == printed
    assert printed["format"] == "holonom-record"


def test_check_reports_every_equation(particle_scene, holonom_here):
    done = holonom_here("check", particle_scene, "--json", "-")
    report = json.loads(done.stdout)
    assert done.returncode == 0
    assert report["scene"] == str(particle_scene)
    assert report["disagreements"] == 0
    assert {"1", "2", "6", "7", "8", "11", "13"} <= {found["number"] for found in report["equations"]}
    assert {found["verdict"] for found in report["equations"]} <= {Verdict.PROVED, Verdict.AGREES, Verdict.NOTHING}


def test_check_of_several_scenes_is_an_array(particle_scene, holonom_here):
    reports = json.loads(holonom_here("check", particle_scene, particle_scene, "--json", "-").stdout)
    assert [report["scene"] for report in reports] == [str(particle_scene)] * 2


def test_check_of_an_invalid_scene_checks_the_others(particle_scene, holonom_here, tmp_path):
    invalid = tmp_path / "invalid.mac"
    invalid.write_text("system : 1$")
    done = holonom_here("check", invalid, particle_scene, invalid, "--json", tmp_path / "found.json")
    assert done.returncode == 2
    assert done.stderr.count("holonom: error:") == done.stderr.count("invalid.mac") == 2
    (report,) = json.loads((tmp_path / "found.json").read_text())
    assert (report["scene"], report["disagreements"]) == (str(particle_scene), 0)
    assert holonom_here("check", invalid, invalid, "--json", tmp_path / "none.json").returncode == 2
    assert not (tmp_path / "none.json").exists()


def test_a_disagreement_is_reported_and_leaves_with_one(particle_record, monkeypatch, capsys, particle_scene):
    wrong = json.loads(particle_record)
    multipliers = next(e for e in wrong["derivations"][0]["equations"] if e["id"] == "multipliers")
    multipliers["relations"][0]["right"] = ["Multiply", 2, multipliers["relations"][0]["right"]]
    monkeypatch.setattr("holonom.record.read_record", lambda _: read_record(json.dumps(wrong)))
    monkeypatch.setattr("sys.argv", ["holonom", "check", str(particle_scene)])
    assert run() == 1
    assert "disagrees" in capsys.readouterr().out


def test_errata_lists_every_equation(holonom_here):
    report = json.loads(holonom_here("errata", "--json", "-").stdout)
    rows = {row["number"]: row for row in report["equations"] if row["number"]}
    assert {str(number) for number in range(2, 20)} <= rows.keys()
    assert all(row["agrees"] or (row["difference"] and row["corrected"]) for row in report["equations"])


@pytest.mark.parametrize(
    "arguments",
    [
        ["derive", "nowhere.mac"],
        ["check", "nowhere.mac"],
        ["derive"],
        ["check"],
        ["derive", "x", "--surprise"],
        ["surprise"],
        ["derive", "x", "--time-limit", "-1"],
    ],
)
def test_bad_arguments_leave_with_two(arguments, holonom_here):
    done = holonom_here(*arguments)
    assert done.returncode == 2
    assert done.stdout == ""
    assert "Traceback" not in done.stderr


def test_bad_input_is_one_sentence_and_writes_nothing(write_scene, tmp_path):
    scene = write_scene('x : 1$\nerror("holonomic_system: lost")$')
    done = holonom("derive", scene, "--json", tmp_path / "record.json")
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr == f"holonom: error: {scene}:2: holonomic_system: lost.\n"
    assert os.listdir(tmp_path) == [scene.name]


def test_verbose_shows_how_to_repeat_the_run(write_scene):
    done = holonom("--verbose", "derive", write_scene('print("printed")$ error("lost")$'))
    assert "printed" in done.stderr
    assert "maxima --" in done.stderr


def test_an_output_that_cannot_be_written(particle_scene, tmp_path, holonom_here):
    done = holonom_here("derive", particle_scene, "--json", tmp_path / "nowhere" / "record.json")
    assert done.returncode == 2
    assert re.search(message_of(ErrorKind.UNWRITABLE, "record.json"), done.stderr)


def test_a_reader_who_leaves_early_is_no_error(particle_scene):
    command = f"{' '.join(HOLONOM)} derive {particle_scene} | head -n 1"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, timeout=60)
    assert without_notice(done.stderr) == ""


@pytest.mark.parametrize(
    ("arguments", "meant"),
    [
        (["simulat", "scene.mac"], "simulate"),
        (["derive", "examples/pendulm.mac"], "examples/pendulum.mac"),
        (["series", "examples/pendulum.mac", "--ordr", "3"], "--order"),
    ],
)
def test_a_name_that_is_nearly_right_gets_the_right_one(arguments, meant):
    done = holonom(*arguments, cwd=Path(__file__).parents[1])
    assert done.returncode == 2
    assert meant in done.stderr


def test_a_scene_may_stand_on_standard_input(particle_scene):
    text = particle_scene.read_text()
    done = holonom("derive", "-", "--json", "-", input=text)
    assert done.returncode == 0
    assert json.loads(done.stdout) == json.loads(holonom("derive", particle_scene, "--json", "-").stdout)


@pytest.mark.long
def test_check_named_a_temporary_file_for_what_stands_on_standard_input(particle_scene):
    text = particle_scene.read_text()
    assert json.loads(holonom("check", "-", "--json", "-", input=text).stdout)["scene"] == "-"
    assert holonom("check", "-", input=text).stdout.startswith("-\n")


def test_what_is_wrong_on_standard_input_is_reported_of_standard_input():
    done = holonom("derive", "-", input="a : 1$\nb : $\n")
    assert done.returncode == 2
    assert "standard input:2: " in done.stderr
    assert "standard_input.mac" not in done.stderr


def test_quiet_prints_nothing_but_what_is_asked_for(particle_scene, holonom_here):
    silent, asked = (
        holonom_here("-q", "check", particle_scene),
        holonom_here("-q", "check", particle_scene, "--json", "-"),
    )
    assert (silent.returncode, silent.stdout) == (0, "")
    assert json.loads(asked.stdout)["disagreements"] == 0


def test_tables_are_not_cut_in_a_pipe(write_scene):
    name = "x" + "_very_long" * 19
    scene = write_scene(f"""load("holonom.mac")$
system : holonomic_system(coordinates = [{name}], kinetic_energy = dot({name})^2/2, constraints = [])$
fall : holonomic_scene(system, initial_state = [{name} = 0, dot({name}) = 1], time_span = [0, 1])$""")
    assert f"dot({name})" in holonom("simulate", scene, "--final").stdout
    assert name in holonom("series", scene, "--order", "3").stdout


def test_version_tells_all_that_decides_the_numbers(holonom_here):
    told = dict(line.split(maxsplit=1) for line in holonom_here("--version").stdout.splitlines())
    assert set(told) == {"holonom", "Maxima", "heyoka", "SymPy"}
    assert told["Maxima"].startswith(f"{version_of_maxima()} on ")
    assert told["SymPy"] == metadata.version("sympy")


def version_of_maxima() -> str:
    printed = subprocess.run(["maxima", "--version"], capture_output=True, text=True, check=True).stdout
    return printed.split()[-1]


def test_doctor_tells_what_is_missing_and_the_command_that_installs_it(tmp_path):
    (tmp_path / "bwrap").write_text("#!/bin/sh\necho 'bwrap: Operation not permitted' >&2\nexit 1\n")
    (tmp_path / "bwrap").chmod(0o755)
    environment = {**os.environ, "PATH": f"{tmp_path}:{Path(sys.executable).parent}"}
    done = holonom("doctor", "--json", "-", env=environment)
    components = {each["name"]: each for each in json.loads(done.stdout)["components"]}
    assert done.returncode == 1
    assert components["maxima"]["version"] is None
    assert "maxima" in components["maxima"]["hint"]
    assert components["bwrap"]["version"] is None
    assert components["bwrap"]["hint"]
    assert components["sympy"]["version"] == metadata.version("sympy")
    assert "holonom[motion]" in components["heyoka"]["hint"]


@pytest.mark.skipif(not (shutil.which("bwrap") and SHARE), reason="Maxima's share library cannot be hidden here")
def test_doctor_misses_the_share_library_of_maxima(tmp_path):
    hidden = ["bwrap", "--dev-bind", "/", "/", "--tmpfs", *SHARE]
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path)}
    command = [*hidden, sys.executable, "-m", "holonom", "doctor", "--json", "-"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    components = {each["name"]: each for each in json.loads(done.stdout)["components"]}
    assert (done.returncode, components["maxima"]["version"]) == (1, None)


def test_doctor_finds_this_installation_whole(holonom_here):
    done = holonom_here("doctor")
    assert done.returncode == 0
    assert metadata.version("heyoka") in done.stdout


@pytest.mark.parametrize("kind", list(ErrorKind))
def test_advice_names_no_option_that_the_command_lacks(kind):
    parts = (kind.reason, *kind.hints)
    named = {name for part in parts for _, name, _, _ in Formatter().parse(part) if name and name[:2] != "--"}
    error = HolonomError(kind, "scene.mac", "detail", **dict.fromkeys(named - {"detail"}, 1))
    assert "--" not in str(error)
    assert "--" not in error.message(())
    assert error.message({"--until", "--time-limit", "--engine", "--stabilization", "--precision"}).endswith(".")


@pytest.mark.long
def test_check_and_derive_were_silent_about_equations_that_are_not_made(holonom_here):
    chain = str(EXAMPLES / "chain.mac")
    report = json.loads(holonom_here("check", chain, "--json", "-").stdout)
    assert (report["left_out"], report["disagreements"]) == (9, 0)
    left_out = {found["number"] for found in report["equations"] if found["verdict"] == "left out"}
    assert left_out == {"4", "5", "8", "9", "10", "11", "13", "18"}
    assert all("closed_form_size" in each["detail"] for each in report["equations"] if not each["id"])
    assert "--closed-form-size 3288 " in holonom_here("derive", chain).stdout
    made = holonom_here("derive", chain, "--set", "N=2", "--closed-form-size", "1")
    assert "(4), (5), (8), (9), (10), (11) " in made.stdout


def test_closed_forms_that_no_memory_holds_were_promised_by_an_option_of_thirty_digits():
    """--closed-form-size 220755541336686592524288000000 was advised for a slider-crank of three bodies in space."""
    said = why_left_out(LeftOut(("4",), 220755541336686592524288000000, 500))
    assert said == "closed forms of 2e+29 terms are expected, more than closed_form_size = 500 and than memory holds"
    assert why_left_out(LeftOut(("4",), LARGEST_SIZE, 500)).startswith("closed forms of 1e+300 terms or more")


def test_equations_left_out_for_a_small_limit_were_called_missing(particle_scene, holonom_here):
    done = holonom_here("check", particle_scene, "--closed-form-size", "1", "--json", "-")
    report = json.loads(done.stdout)
    assert (done.returncode, report["disagreements"]) == (0, 0)
    left_out = {found["number"] for found in report["equations"] if found["verdict"] == "left out"}
    assert left_out == {"4", "5", "8", "9", "10", "11", "13", "18"}


def test_the_scene_file_s_closed_form_size_had_no_effect(write_scene, holonom_here):
    scene = write_scene(PARTICLE + "closed_form_size : 1$\n")
    assert "closed_form_size = 1;" in holonom_here("derive", scene).stdout
    assert "closed_form_size = 1" not in holonom_here("derive", scene, "--closed-form-size", "500").stdout
    scene.write_text(PARTICLE + "closed_form_size : 0$\n")
    refused = holonom_here("derive", scene)
    assert refused.returncode == 2
    assert re.search(message_of(ErrorKind.REFUSED, "closed_form_size", "0"), refused.stderr)


def test_a_law_that_sympy_contradicts_had_exit_status_0(particle_scene, monkeypatch):
    contradicted = CheckResult(Verdict.DISAGREES, 50, 8, "lambda1 is 1")
    monkeypatch.setattr("holonom.free_verdicts.verify_law", lambda *_: contradicted)
    found = CliRunner().invoke(cli, ["free", str(particle_scene)], standalone_mode=False)
    assert found.return_value == 1
    assert re.search(f"{Verdict.DISAGREES} .* 50 .* 8 .*: lambda1 is 1", found.output)


def test_an_internal_error_had_the_status_of_a_disagreement(monkeypatch):
    monkeypatch.setattr("holonom.errata.errata", lambda: [].missing)
    found = CliRunner().invoke(cli, ["errata"], standalone_mode=False)
    assert found.return_value == 70
    assert "AttributeError" in found.output


@pytest.mark.parametrize(("other", "status"), [(HolonomError(ErrorKind.NO_LAW), 2), (ValueError("other"), 70)])
def test_errors_together_are_internal_if_one_is(other, status, monkeypatch):
    def raising():
        raise ExceptionGroup("several", [HolonomError(ErrorKind.NEVER_AT_REST), other])

    monkeypatch.setattr("holonom.errata.errata", raising)
    assert CliRunner().invoke(cli, ["errata"], standalone_mode=False).return_value == status


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (("simulate", "--untl", "3"), ("--untl", "--until")),
        (("--verbos",), ("--verbos", "--verbose")),
        (("simulat",), ("simulat", "simulate")),
        (("series", "--digits", "x"), ("--digits", "'x'", "integer")),
    ],
)
def test_an_error_of_the_command_line_names_what_it_is_about(words, named, monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["holonom", *words])
    assert run() == 2
    assert re.search("holonom: error: .*" + ".*".join(map(re.escape, named)), capsys.readouterr().err)


def test_a_long_condition_is_printed_by_its_terms_with_its_roots_under_names():
    distance = ["Add", ["Power", "x", 2], ["Power", "y", 2]]
    short = ["Multiply", "x", ["Power", distance, ["Rational", -1, 2]]]
    assert condition_lines(short) == ["x/sqrt(x^2 + y^2) = 0"]
    one = condition_lines(["Divide", ["Add", *[["Power", "x", k] for k in range(2, 40)]], 2])
    assert (len(one), one[0][-5:]) == (1, "2 = 0")
    terms = [["Multiply", k, "r1", ["Power", distance, ["Rational", k, 2]], ["Sqrt", 3]] for k in (-1, 3, 5, 7, 9)]
    assert condition_lines(["Add", *terms, ["Power", "x", ["Rational", 1, 3]]]) == [
        "with rr1 = sqrt(x^2 + y^2)",
        "with rr2 = x^(1/3)",
        "0 = the sum of",
        "    -r1*sqrt(3)/rr1",
        *(f"    {k}*r1*rr1^{k}*sqrt(3)" for k in (3, 5, 7, 9)),
        "    rr2",
    ]
