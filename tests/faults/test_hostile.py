"""Untrusted scenes: what a hostile one tries, each in a run of its own, and that it has nothing of it.

The scenes run in Maxima, where a file may call any program and any Lisp function.
"""

import json
import os
import socket
import subprocess
import sys
from pathlib import Path

import pytest
from confinement import needs_sandbox
from particle import PARTICLE
from shell import SHELL

from holonom.documents import ask
from holonom.failures import ErrorKind, HolonomError
from holonom.formats import Document
from holonom.hidden import hidden_character
from holonom.sandbox import UNSANDBOXED, Limits, Sandbox
from holonom.source import Source


def scene(tmp_path: Path, deed: str, *, before: str = "") -> Path:
    folder = tmp_path / "scene"
    folder.mkdir()
    file = folder / "scene.mac"
    file.write_text(before + PARTICLE + SHELL + deed, encoding="utf-8")
    return file


def told(tmp_path: Path, command: str) -> str:
    """What a program says that a scene runs: the scene makes it the title of its system."""
    text = (
        f'load("holonom.mac")$ {SHELL} in_a_shell("{command} > seen 2>&1")$ file : openr("seen")$ said : ""$ '
        "while stringp(line : readline(file)) do said : sconcat(said, line)$ "
        "system : holonomic_system(title = said, coordinates = [x], kinetic_energy = dot(x)^2/2)$"
    )
    file = tmp_path / "telling.mac"
    file.write_text(text, encoding="utf-8")
    return json.loads(ask(Document.RECORD, file))["system"]["title"]


def test_what_a_program_says_can_be_known(tmp_path):
    assert told(tmp_path, "echo hello") == "hello"


@needs_sandbox
@pytest.mark.parametrize("where", ["outside", "in /etc"])
def test_no_file_outside_its_folder_is_read(where, tmp_path):
    folder, secret = tmp_path / "scene", tmp_path / "secret"
    folder.mkdir()
    secret.write_text("root: the secret")
    said = told(folder, f"cat {secret if where == 'outside' else '/etc/passwd'}")
    assert "No such file" in said
    assert "root:" not in said


@needs_sandbox
@pytest.mark.parametrize("place", ["{outside}/new", "{outside}/old", "{library}/holonom.mac", "{folder}/scene.mac"])
def test_no_file_is_written(place, tmp_path):
    import holonom.maxima

    outside = tmp_path / "outside"
    outside.mkdir()
    (outside / "old").write_text("as it was")
    library = holonom.maxima.LIBRARY
    target = Path(place.format(outside=outside, library=library, folder=tmp_path / "scene"))
    deed = f'errcatch(with_stdout("{target}", print("forged")))$ in_a_shell("echo forged >> {target}; rm -r {target}")$'
    file = scene(tmp_path, deed)
    before = target.read_bytes() if target.exists() else None
    ask(Document.RECORD, file)
    assert (target.read_bytes() if target.exists() else None) == before


@needs_sandbox
def test_there_is_no_network(tmp_path):
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.settimeout(0.2)
        port = server.getsockname()[1]
        ask(Document.RECORD, scene(tmp_path, f"in_a_shell(\"bash -c 'echo hello > /dev/tcp/127.0.0.1/{port}'\")$"))
        with pytest.raises(TimeoutError):
            server.accept()


@needs_sandbox
def test_no_other_process_is_seen_or_ended(tmp_path):
    victim = subprocess.Popen(["sleep", "60"])
    try:
        ask(Document.RECORD, scene(tmp_path, f'in_a_shell("kill -9 {victim.pid}")$'))
        assert victim.poll() is None
    finally:
        victim.kill()
        victim.wait()


@needs_sandbox
def test_nothing_runs_on_that_hides_in_a_session_of_its_own(tmp_path):
    mark = f"{os.getpid()}.125"
    released = " ".join(f"{number}>&-" for number in range(3, 10))  # newer versions of GCL wait until these are closed
    ask(Document.RECORD, scene(tmp_path, f'in_a_shell("setsid sleep {mark} >/dev/null 2>&1 {released} &")$'))
    seen = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True, check=True).stdout
    assert f"sleep {mark}" not in seen


@needs_sandbox
def test_the_environment_is_not_shown(tmp_path, monkeypatch):
    monkeypatch.setenv("TOKEN", "the secret")
    said = told(tmp_path, "env")
    assert "HOME=" in said
    assert "the secret" not in said


REFUSALS = {
    ErrorKind.OUTPUT_TRUNCATED,
    ErrorKind.REFUSED,
    ErrorKind.NOTHING_WRITTEN,
    ErrorKind.LISP_ERROR,
    ErrorKind.ENDED_EARLY,
}
FORGERIES = {
    "the writer of the record": 'write_record(file) := with_stdout(file, print("{\\"forged\\" : true}"))$',
    "the derivation": "derive(system) := error(sconcat(forged))$ multipliers_of([x]) := [0]$",
    "the first steps": "christoffel_first_kind([x]) := zeromatrix(2, 2)$ mass_matrix([x]) := ident(2)$ diff([x]) := 0$",
    "Lisp's own functions": r'?eval(?read\-from\-string("(defun $diff (&rest x) (declare (ignore x)) 0)"))$',
    "the outcome": "in_a_shell(\"for f in outcome-*; do printf 'forged' > $f; done\")$",
    "the document": 'in_a_shell("touch document-0 document; cp document document-1")$',
    "the way out": "?leave : 0$",
}


@pytest.mark.parametrize("forgery", FORGERIES)
def test_what_derives_is_not_what_the_scene_has_touched(forgery, tmp_path, particle_record):
    """A forger is refused, for its own run is broken, or changes nothing of the derivation."""
    try:
        found = ask(Document.RECORD, scene(tmp_path, FORGERIES[forgery]))
    except HolonomError as refusal:
        found = None
        refused = refusal.kind
    assert refused in REFUSALS if found is None else derivations(found) == derivations(particle_record)


def derivations(record: str) -> list:
    return json.loads(record)["derivations"]


def test_a_system_that_is_changed_afterwards_is_derived_as_its_description_shows_it(tmp_path):
    source = Source(scene(tmp_path, "particle@constraints : [z - 2*u]$ "))
    record = json.loads(ask(Document.RECORD, source))
    shown = source.description().content["system"]["constraints"]
    assert shown == record["system"]["constraints"] == [["Add", ["Multiply", -2, "u"], "z"]]


@pytest.mark.parametrize("letter", ["\u202e", "\u2066", "\x07", "\x9b", "\u2028", "\u200b"])
def test_titles_hold_no_characters_that_hide_or_reverse_text(letter, tmp_path):
    file = tmp_path / "scene.mac"
    file.write_text(PARTICLE.replace('"Particle', f'"{letter}Particle'), encoding="utf-8")
    with pytest.raises(HolonomError) as raised:
        ask(Document.RECORD, file)
    assert (raised.value.kind, raised.value.detail) == (ErrorKind.HIDDEN_CHARACTER, f"U+{ord(letter):04X}")


def test_messages_show_the_characters_that_hide_or_reverse_text(tmp_path):
    with pytest.raises(HolonomError) as raised:
        ask(Document.RECORD, scene(tmp_path, 'print("\u202eon the way")$ error("\x1b[2Jlost\u202e")$'))
    assert raised.value.detail == r"\x1b[2Jlost\u202e"
    assert not any(map(hidden_character, raised.value.last_lines))


@pytest.mark.parametrize(
    "option", ["numer : true", "obase : 8", "modulus : 7", "keepfloat : true", "simp : true", "exptdispflag : false"]
)
def test_options_of_maxima_do_not_reach_the_derivation(option, tmp_path, particle_record):
    assert derivations(ask(Document.RECORD, scene(tmp_path, "", before=f"{option}$ "))) == derivations(particle_record)


def test_a_trusted_scene_is_run_in_the_open(tmp_path):
    target = tmp_path / "written"
    trusted = Limits(sandbox=Sandbox.TRUSTED)
    ask(Document.RECORD, scene(tmp_path, f'with_stdout("{target}", print("here"))$'), limits=trusted)
    assert target.read_text().strip() == "here"


FORBIDDEN = "#!/bin/sh\necho 'bwrap: No permissions to create new namespace' >&2\nexit 1\n"


@pytest.mark.parametrize("bubblewrap", ["missing", "forbidden"])
def test_missing_sandbox_is_reported_and_derivation_is_same(bubblewrap, tmp_path, particle_record):
    programs = tmp_path / "programs"
    programs.mkdir()
    found = {each.name: each for folder in reversed(os.get_exec_path()) for each in Path(folder).glob("*")}
    for name in found.keys() - {"bwrap"}:
        (programs / name).symlink_to(found[name])
    if bubblewrap == "forbidden":
        (programs / "bwrap").write_text(FORBIDDEN)
        (programs / "bwrap").chmod(0o755)
    done = subprocess.run(
        [sys.executable, "-m", "holonom", "derive", str(scene(tmp_path, "")), "--json", "-"],
        env=os.environ | {"PATH": str(programs), "XDG_CACHE_HOME": os.devnull},  # no image of Maxima is made for this
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, f"holonom: warning: {UNSANDBOXED}\n")
    assert derivations(done.stdout) == derivations(particle_record)
