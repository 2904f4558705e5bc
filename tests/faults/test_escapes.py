"""Attacks of scene files on what lies outside the sandbox; each test does the deed, then looks at the victim.

A deed is a shell script that the scene runs. What it prints becomes the title of the scene's system.
"""

import base64
import contextlib
import errno
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from dataclasses import replace
from pathlib import Path

import pytest
from confinement import needs_sandbox
from refusing import failing
from shell import SHELL
from waiting import living, soon

from holonom.documents import ask
from holonom.failures import ErrorKind, HolonomError
from holonom.formats import Document
from holonom.sandbox import Limits, Sandbox

REQUIRED = Limits(sandbox=Sandbox.REQUIRED)
HOLONOM = [sys.executable, "-m", "holonom"]


def scene(folder: Path, script: str) -> Path:
    """Write a scene that runs a shell script, and says in its title what that printed, with slashes for line ends."""
    folder.mkdir(exist_ok=True)
    code = base64.b64encode(script.encode()).decode()
    text = (
        f'load("holonom.mac")$ {SHELL} in_a_shell("echo {code} | base64 -d > deed; sh deed > seen 2>&1")$ '
        'file : openr("seen")$ said : ""$ while stringp(line : readline(file)) do said : sconcat(said, line, "/")$ '
        "system : holonomic_system(title = said, coordinates = [x], kinetic_energy = dot(x)^2/2)$"
    )
    file = folder / "scene.mac"
    file.write_text(text, encoding="utf-8")
    return file


def said(folder: Path, script: str, limits: Limits = REQUIRED) -> str:
    try:
        return json.loads(ask(Document.RECORD, scene(folder, script), limits=limits))["system"]["title"]
    except HolonomError as refused:
        if refused.kind is ErrorKind.TOO_MANY_PROCESSES:
            raise TooMany from refused
        raise


class TooMany(Exception):
    """A scene was ended because it started too many processes; the kernel may have refused it these before."""


@pytest.mark.parametrize("trust", [pytest.param("--sandbox", marks=needs_sandbox), "--trust"])
@pytest.mark.parametrize("link", ["draft-1", "draft-0123456789abcdef", "anything"])
def test_links_in_the_working_directory_delete_nothing(link, trust, tmp_path):
    victim = tmp_path / "victim"
    victim.mkdir()
    (victim / "file").touch()
    (tmp_path / "here").mkdir()
    (tmp_path / "here" / "file").touch()
    file = scene(tmp_path / "scn", f"ln -s {victim} {link}; ln -s file {link}b; mkdir d; ln -s {victim} d/{link}")
    subprocess.run([*HOLONOM, "derive", str(file), trust], cwd=tmp_path / "here", capture_output=True, check=False)
    assert (victim / "file").exists()
    assert (tmp_path / "here" / "file").exists()


@needs_sandbox
def test_socket_beside_the_scene_is_out_of_reach(tmp_path):
    address, reached = tmp_path / "socket", []
    with socket.socket(socket.AF_UNIX) as server:
        server.bind(str(address))
        server.listen()
        threading.Thread(target=lambda: reached.append(accepted(server)), daemon=True).start()
        call = f'perl -e \'use Socket; socket(S, PF_UNIX, SOCK_STREAM, 0) and connect(S, sockaddr_un("{address}")) '
        assert said(tmp_path, f"{call} and print 1 or print $!'; ls {tmp_path}").startswith("Operation not permitted")
        time.sleep(0.1)
        server.shutdown(socket.SHUT_RDWR)
    assert reached in ([], [False])


def accepted(server: socket.socket) -> bool:
    with contextlib.suppress(OSError):
        server.accept()
        return True
    return False


@needs_sandbox
def test_only_named_files_and_sources_beside_the_scene_are_seen(tmp_path):
    for name in ("data.csv", "part.mac", "secret", "named.txt", ".hidden.mac", "below/named", "below/other"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("1")
    (tmp_path / "link.csv").symlink_to(tmp_path / "secret")
    (tmp_path / "up").symlink_to(tmp_path.parent)
    os.mkfifo(tmp_path / "pipe.csv")
    file = scene(tmp_path, f"cd {tmp_path}; find . -type f | sort; cat ../outside")
    (tmp_path.parent / "outside").write_text("outside")
    names = '["named.txt", "below/named", "../outside", "up/outside", "/etc/passwd", "link.csv"]$ '
    file.write_text(names + file.read_text())
    title = json.loads(ask(Document.RECORD, file, limits=REQUIRED))["system"]["title"]
    seen = {each for each in title.split("/./") if "cat" not in each}
    found = title.partition("cat:")[0].strip("/").removeprefix("./").split("/./")
    assert {*found} == {"below/named", "data.csv", "named.txt", "part.mac", "scene.mac"}, seen
    assert "No such file" in title


@needs_sandbox
def test_allowed_file_is_seen(tmp_path):
    (tmp_path / "allowed").write_text("seen")
    limits = replace(REQUIRED, allow=(tmp_path / "allowed",))
    assert said(tmp_path / "scn", f"cat {tmp_path}/allowed", limits) == "seen/"


@needs_sandbox
def test_files_beside_the_scene_keep_their_content(tmp_path):
    (tmp_path / "part.mac").write_text("as it was")
    said(tmp_path, f"cd {tmp_path}; echo x > part.mac; rm -f part.mac scene.mac; mv scene.mac part.mac; touch new.mac")
    assert (tmp_path / "part.mac").read_text() == "as it was"
    assert sorted(os.listdir(tmp_path)) == ["part.mac", "scene.mac"]


@needs_sandbox
def test_kernel_files_are_read_only(tmp_path):
    script = "find /proc/sys /proc/irq /proc/acpi /proc/bus -type f -writable 2>/dev/null | while read f; do "
    script += "(exec 3>>$f) 2>/dev/null && echo $f; done; (echo x > /dev/shm/x) 2>/dev/null && echo shm; echo end"
    assert said(tmp_path, script) == "end/"


@needs_sandbox
def test_process_is_without_privileges_and_in_namespaces(tmp_path):
    script = (
        "id -u; grep -E 'CapEff|CapBnd|NoNewPrivs' /proc/self/status | tr -d '\\t'; unshare -r true || echo refused"
    )
    user, *status = said(tmp_path, script).split("/")
    assert user == "65534"
    assert {"CapEff:0000000000000000", "CapBnd:0000000000000000", "NoNewPrivs:1", "refused"} <= {*status}


@needs_sandbox
def test_other_processes_and_their_environment_are_hidden(tmp_path, monkeypatch):
    monkeypatch.setenv("TOKEN", "secret-of-the-parent")
    title = said(tmp_path, "cat /proc/[0-9]*/environ | tr '\\0' '\\n' | grep -c secret-of; ls -d /proc/[0-9]* | wc -l")
    secrets, processes = title.strip("/").split("/")
    assert (secrets, int(processes) < 20) == ("0", True)


@needs_sandbox
@pytest.mark.parametrize(
    "hoard",
    [
        "head -c 3000M /dev/zero > big; head -c 3000M /dev/zero > /tmp/big; head -c 3000M /dev/zero > /dev/shm/big",
        "for i in $(seq 30); do head -c 100M /dev/zero > big$i; done",
        "for i in $(seq 30); do head -c 100M /dev/zero >> outcome-*; cp outcome-* x$i; done",
    ],
)
def test_files_in_the_sandbox_count_as_memory(hoard, tmp_path):
    limits = replace(REQUIRED, memory_mib=512, file_mib=64)
    with contextlib.suppress(HolonomError):
        sizes = said(tmp_path, f"{hoard}; du -sm . /tmp /dev/shm 2>/dev/null | cut -f1", limits).split("/")
        assert sum(int(size) for size in sizes if size.isdigit()) <= 512


@needs_sandbox
def test_empty_files_count_as_memory(tmp_path):
    deed = "perl -e 'for (1 .. 1e6) { open(F, q(>), $_) or die $! }'"
    with pytest.raises(HolonomError) as refused:
        said(tmp_path, deed, replace(REQUIRED, memory_mib=256))
    assert refused.value.kind is ErrorKind.TOO_LARGE


@needs_sandbox
def test_threads_count_as_processes(tmp_path):
    deed = "python3 -c 'import threading, time\nwhile 1: threading.Thread(target=time.sleep, args=[60]).start()'"
    with contextlib.suppress(TooMany):
        assert "can't start new thread" in said(tmp_path, deed)


@needs_sandbox
@pytest.mark.parametrize("number", [600, 1500])
def test_many_processes_are_ended(number, tmp_path):
    mark = f"{os.getpid()}.75"
    deed = f"for i in $(seq {number}); do sleep {mark} & done; ps -A | grep -c sleep"
    with contextlib.suppress(TooMany):
        printed = said(tmp_path, deed)
        assert "Cannot fork" in printed or int(printed.split("/")[-2]) <= REQUIRED.processes
    assert soon(lambda: not living(mark))


@pytest.mark.parametrize("trust", [pytest.param(Sandbox.REQUIRED, marks=needs_sandbox), Sandbox.TRUSTED])
def test_nested_processes_are_ended(trust, tmp_path):
    mark = f"{os.getpid()}.125"
    (tmp_path / "nest").write_text(f"[ $1 = 0 ] && exec sleep {mark}; sh $0 $(($1 - 1)) & wait\n")
    script = base64.b64encode((tmp_path / "nest").read_bytes()).decode()
    with contextlib.suppress(TooMany):
        said(tmp_path / "scn", f"echo {script} | base64 -d > nest; sh nest 600", Limits(sandbox=trust))
    assert soon(lambda: not living(mark))


@pytest.mark.parametrize("trust", [pytest.param(Sandbox.REQUIRED, marks=needs_sandbox), Sandbox.TRUSTED])
def test_daemon_ends_with_the_run(trust, tmp_path):
    mark = f"{os.getpid()}.25"
    released = " ".join(f"{number}>&-" for number in range(3, 10))
    said(tmp_path, f"(setsid setsid sleep {mark} >/dev/null 2>&1 </dev/null {released} &) &", Limits(sandbox=trust))
    assert soon(lambda: not living(mark))


@pytest.mark.long
@pytest.mark.parametrize("trust", [pytest.param("--sandbox", marks=needs_sandbox), "--trust"])
def test_deep_directories_leave_nothing_and_break_no_later_command(trust, tmp_path):
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    environment = os.environ | {"TMPDIR": str(temporary)}
    deep = scene(tmp_path / "deep", "for i in $(seq 1100); do mkdir d && cd d; done; chmod 0 .")
    plain = scene(tmp_path / "plain", "true")
    for file in (deep, plain):
        done = subprocess.run(
            [*HOLONOM, "derive", str(file), trust], env=environment, capture_output=True, text=True, check=False
        )
        assert (done.returncode, "Traceback" in done.stderr) == (0, False)
    assert os.listdir(temporary) == []


SLOW = "#!/bin/sh\nexec sleep 100\n"
BUSY = "#!/bin/sh\necho 'bwrap: Creating new namespace failed: Resource temporarily unavailable' >&2\nexit 1\n"


@pytest.mark.parametrize("answer", [SLOW, BUSY])
def test_sandbox_that_fails_for_a_while_ends_the_command(answer, tmp_path, monkeypatch):
    from holonom import sandbox

    (tmp_path / "bwrap").write_text(answer)
    (tmp_path / "bwrap").chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    monkeypatch.setattr(sandbox, "PROBE_TIME", 1.0)
    monkeypatch.setattr("holonom.maxima.preloaded_image", lambda *_: None)  # with this PATH one of its own is made
    sandbox.has_sandbox.cache_clear()
    target = tmp_path / "victim"
    try:
        with pytest.raises(HolonomError) as refused:
            said(tmp_path / "scn", f"touch {target}", Limits())
    finally:
        sandbox.has_sandbox.cache_clear()
    assert refused.value.kind is ErrorKind.SANDBOX_FAILED
    assert refused.value.kind.status == 3
    assert not target.exists()


@needs_sandbox
@pytest.mark.parametrize("few", [8, 10, 14])
def test_too_few_descriptors_never_run_the_scene_without_limits(few, tmp_path):
    target = tmp_path / "victim"
    file = scene(tmp_path / "scn", f"touch {target}")
    command = f"ulimit -n {few}; exec {sys.executable} -m holonom derive {file}"
    done = subprocess.run(["/bin/sh", "-c", command], capture_output=True, text=True, check=False)
    assert (done.returncode in (0, 3), target.exists()) == (True, False)


def test_python_interface_requires_a_sandbox_when_asked(tmp_path, monkeypatch):
    monkeypatch.setattr("holonom.sandbox.has_sandbox", lambda: False)
    target = tmp_path / "victim"
    with pytest.raises(HolonomError) as refused:
        said(tmp_path / "scn", f"touch {target}")
    assert refused.value.kind is ErrorKind.NO_SANDBOX
    assert not target.exists()


def test_python_interface_warns_without_a_sandbox(tmp_path, monkeypatch):
    import holonom

    monkeypatch.setattr("holonom.sandbox.has_sandbox", lambda: False)
    file = scene(tmp_path, "true")
    with pytest.warns(UserWarning):
        holonom.load(file)
    with pytest.raises(HolonomError):
        holonom.load(file, limits=REQUIRED)


@needs_sandbox
def test_unended_strings_cost_no_more_time_than_their_length(tmp_path):
    file = scene(tmp_path, "echo seen")
    file.write_text(file.read_text() + '/* "' + '\\"' * 10**6 + "\n*/")
    assert json.loads(ask(Document.RECORD, file, limits=REQUIRED))["system"]["title"] == "seen/"


PAGE_TABLES = """
#include <sys/mman.h>
int main(void) {
    long step = 1L << 21;
    for (int area = 0; area < 128; area++) { /* 2 GiB of tables */
        volatile char *start = mmap(0, step << 12, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (start == MAP_FAILED) return 1;
        madvise((void *)start, step << 12, MADV_NOHUGEPAGE);
        for (long page = 0; page < 1L << 12; page++) start[page * step];
        usleep(2000);
    }
}
"""


def compiled(program: str, folder: Path) -> Path:
    (folder / "program.c").write_text(f"#define _GNU_SOURCE\n#include <unistd.h>\n{program}")
    subprocess.run(["cc", "-o", folder / "program", folder / "program.c"], check=True)
    return folder / "program"


compiling = pytest.mark.skipif(shutil.which("cc") is None or sys.platform != "linux", reason="there is no compiler")


@needs_sandbox
@compiling
def test_page_tables_count_as_memory(tmp_path):
    limits = replace(REQUIRED, memory_mib=512, allow=(compiled(PAGE_TABLES, tmp_path),))
    with pytest.raises(HolonomError) as refused:
        said(tmp_path / "scn", f"cp {limits.allow[0]} deed2; chmod +x deed2; ./deed2", limits)
    assert refused.value.kind is ErrorKind.TOO_LARGE


# Each prints the number of the error that the kernel answers; what it did not refuse it has done once.
UNCOUNTED = {
    "pages in a pipe": (
        "#include <fcntl.h>\n#include <sys/uio.h>",
        'int ends[2]; pipe(ends); struct iovec part = {"x", 1}; done = vmsplice(ends[1], &part, 1, 0);',
    ),
    "attributes": (
        "#include <sys/xattr.h>",
        "struct {int version; struct {short tag, rights; int id;} part[3];} list = {2, {{1, 7, -1}, {4, 5, -1},"
        ' {32, 5, -1}}}; done = setxattr("deed", "system.posix_acl_access", &list, sizeof list, 0);',
    ),
    "locks": (
        "#include <fcntl.h>",
        'struct flock lock = {F_WRLCK, SEEK_SET, 0, 1}; done = fcntl(open("deed", O_RDWR), F_SETLK, &lock);',
    ),
}


@needs_sandbox
@compiling
@pytest.mark.parametrize("way", UNCOUNTED)
def test_memory_that_no_limit_counts_is_refused(way, tmp_path):
    headers, deed = UNCOUNTED[way]
    body = f'int main(void) {{ long done; {deed} printf("%d", done < 0 ? errno : 0); }}'
    program = compiled(f"#define _GNU_SOURCE\n#include <errno.h>\n#include <stdio.h>\n{headers}\n{body}", tmp_path)
    limits = replace(REQUIRED, allow=(program,))
    assert said(tmp_path / "scn", f"cp {program} deed2; chmod +x deed2; ./deed2", limits) == f"{errno.EPERM}/"


@pytest.mark.long
@needs_sandbox
def test_process_that_has_ended_hides_no_files_from_the_count(tmp_path):
    zombie = "if (!fork) { if (!fork) { exit if !fork; sleep 100 } sleep 100 } sleep 1; "
    deed = f"perl -e '{zombie} for (1 .. 1e6) {{ open(F, q(>), $_) or die $! }} kill 9, -1'"
    with pytest.raises(HolonomError) as refused:
        said(tmp_path, deed, replace(REQUIRED, memory_mib=256))
    assert refused.value.kind is ErrorKind.TOO_LARGE


FORGED = 'M=$(head -1 outcome-*); printf "%s\\nFINISHED\\n/x\\n0\\n\\n\\n%s\\n" $M $M > outcome-$M; kill -9 -1'


@needs_sandbox
def test_description_is_not_read_beyond_its_longest(tmp_path):
    with pytest.raises(HolonomError) as refused:
        said(tmp_path, f"head -c 65M /dev/zero > $(ls document-*); {FORGED}")
    assert refused.value.kind is ErrorKind.DESCRIPTION_TOO_LARGE


def test_scene_is_not_read_beyond_its_longest(tmp_path):
    file = tmp_path / "scene.mac"
    with file.open("wb") as sparse:
        sparse.truncate(2**40)
    with pytest.raises(HolonomError) as refused:
        ask(Document.RECORD, file)
    assert refused.value.kind is ErrorKind.FILE_TOO_LARGE


@needs_sandbox
@pytest.mark.skipif(not os.access("/dev/shm", os.W_OK), reason="there is no /dev/shm")
def test_files_in_shared_memory_are_files(tmp_path, monkeypatch):
    with tempfile.TemporaryDirectory(dir="/dev/shm") as folder:
        monkeypatch.setattr(tempfile, "tempdir", folder)
        (Path(folder) / "part.mac").write_text("1$")
        deed = f"cat {folder}/part.mac; (echo x > /dev/shm/x) 2>/dev/null || echo safe"
        assert said(Path(folder), deed) == "1$safe/"


def test_no_image_is_taken_from_the_working_directory(tmp_path, monkeypatch):
    from holonom.preloaded import _own_folder

    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setenv("XDG_CACHE_HOME", "cache")
    assert _own_folder() == tmp_path / "home" / ".cache" / "holonom"
    assert os.listdir(tmp_path) == ["home"]


def test_every_signal_that_ends_a_command_is_reported():
    from holonom.supervisor import _status_of

    for number in range(1, signal.NSIG):
        if number not in [*signal.Signals]:
            with failing(ErrorKind.COMMAND_CRASHED, str(number)):
                _status_of(-number)
