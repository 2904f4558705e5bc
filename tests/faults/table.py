"""The fault table: what is done to a command, and what must be seen.

Each row is one command in a directory of its own, which holds `scene.mac`, the particle on a table, and what `prepare`
puts there. Whatever is done, there is one sentence, the exit status, no traceback, nothing half-written, and nothing
left in the directory for temporary files.
"""

import errno
import os
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from particle import PARTICLE
from refusing import message_of
from shell import SHELL

from holonom.failures import ErrorKind

MACHINE_AT_FAULT = 3
SHORT = 1  # row with the same sentence in the short form
PENDULUM = Path(__file__).resolve().parents[2] / "examples" / "pendulum.mac"
SWING = re.sub(r"load\(.*?\)\)", 'load("holonom.mac")', PENDULUM.read_text(encoding="utf-8"), count=1, flags=re.DOTALL)


@dataclass(frozen=True)
class Fault:
    """A row of the table.

    Attributes
    ----------
    name : str
    command : str
        What follows ``holonom``, words with blanks between them.
    says : str
        Pattern of the message, empty if there is none.
    status : int
    prepare : callable or None
        Given the directory.
    environment : mapping of str to str
        ``{here}`` stands for the directory.
    shell : str
        The shell command, in which ``"$@"`` is the command, where it is not called as it is.
    long : bool
        Whether `make check-long` alone runs it.
    """

    name: str
    command: str
    says: str = ""
    status: int = 2
    prepare: Callable[[Path], object] | None = None
    environment: Mapping[str, str] = field(default_factory=dict)
    shell: str = ""
    long: bool = False


def holding(name: str, content: str | bytes) -> Callable[[Path], object]:
    """Put a file into the directory."""
    data = content.encode() if isinstance(content, str) else content
    return lambda here: (here / name).write_bytes(data)


def executable(name: str, script: str) -> Callable[[Path], object]:
    """Put a program into the directory."""

    def prepare(here: Path) -> None:
        (here / name).write_text(script, encoding="utf-8")
        (here / name).chmod(0o755)

    return prepare


def maxima(script: str, mode: int = 0o755) -> Callable[[Path], object]:
    """Put another program in Maxima's place."""

    def prepare(here: Path) -> None:
        (here / "bin").mkdir()
        (here / "bin" / "maxima").write_text(script)
        (here / "bin" / "maxima").chmod(mode)

    return prepare


def leaving(what: str, command: str) -> Callable[[Path], object]:
    """A Maxima that does no more than to make something of the file it should leave behind."""
    name = f"$(grep -o '{what}-[0-9a-f]*' job.lisp | tail -n 1)"
    return maxima(f"#!/bin/sh\nmark=$(grep -o 'outcome-[0-9a-f]*' job.lisp | tail -n 1)\n{command.format(name=name)}\n")


FINISHED = "printf '%s\\nFINISHED\\n-\\n0\\n\\n\\n%s\\n' ${{mark#outcome-}} ${{mark#outcome-}} > $mark"
OTHER_MAXIMA = {"PATH": "{here}/bin:" + os.environ["PATH"], "XDG_CACHE_HOME": "{here}/../cache"}
ENVELOPE = '{"format": "holonom-free", "version": 2}'
NO_PROGRAMS = {"PATH": "{here}"}
DERIVE = "derive scene.mac --json out.json"

OPTIONS = [
    Fault("an unknown command", "surprise", message_of(None, "surprise")),
    Fault("an unknown option", "derive scene.mac --surprise", message_of(None, "--surprise")),
    Fault("no scene", "derive", message_of(None, "SCENE")),
    Fault("no order", "series scene.mac", message_of(None, "--order")),
    *(
        Fault(f"a time limit of {text}", f"derive scene.mac --time-limit {text}", message_of(None, "--time-limit"))
        for text in ("nan", "inf", "0", "-1", "1e400", "soon", "1e10")
    ),
    *(
        Fault(
            f"a memory limit of {text}", f"derive scene.mac --memory-limit {text}", message_of(None, "--memory-limit")
        )
        for text in ("0", "1", "-5", "1e3", "99999999999999999999")
    ),
    *(
        Fault(f"an end at {text}", f"simulate scene.mac --until {text}", message_of(ErrorKind.NOT_A_TIME))
        for text in ("soon", "nan", "inf", "1/0", "1e400", "1e-400", "1e1000000000", "9" * 400)
    ),
    Fault("a sum at 1e400", "series scene.mac --order 4 --at 1e400", message_of(ErrorKind.NOT_A_TIME)),
    *(
        Fault(f"{text} samples", f"simulate scene.mac --samples {text}", message_of(None, "--samples"))
        for text in ("0", "1", "-3", "1.5", "many")
    ),
    *(
        Fault(f"an order of {text}", f"series scene.mac --order {text}", message_of(None, "--order"))
        for text in ("1", "-1", "x")
    ),
    Fault("no digits", "series scene.mac --order 4 --digits 0", message_of(None, "--digits")),
    Fault("an unknown engine", "simulate scene.mac --engine steam", message_of(None, "--engine")),
    Fault("an unknown stabilization", "simulate scene.mac --stabilization hope", message_of(None, "--stabilization")),
    Fault("an unknown solve", "program scene.mac --solve luck", message_of(None, "--solve")),
    Fault("an unknown form", "program scene.mac --to cobol", message_of(None, "--to")),
    Fault("trusted and needs_sandbox in", "derive scene.mac --trust --sandbox", message_of(None)),
    Fault("exact and in digits", "series scene.mac --order 4 --exact --digits 9", message_of(None)),
    *(
        Fault(f"{text} as a setting", f"derive scene.mac --set {text}", message_of(ErrorKind.NOT_A_SETTING))
        for text in ("m", "m=", "m=x", "=1", "m=1e", "m=system(1)", "m=1;quit()")
    ),
    *(
        Fault(f"{text} as a setting", f"derive scene.mac --set {text}", message_of(ErrorKind.SETTING_TOO_LARGE))
        for text in ("m=1e400", "m=1e-400", "m=1e1000000000", f"m={'9' * 400}")
    ),
    *(
        Fault(
            f"a precision of {text}",
            f"simulate scene.mac --until 1 --precision {text}",
            message_of(ErrorKind.NOT_A_PRECISION, text),
        )
        for text in ("0", "-1", "5001", "1e9", "very")
    ),
    Fault("a name that no scene has", "simulate scene.mac --scene a;b", message_of(ErrorKind.NOT_A_SCENE_NAME)),
]

OUTPUTS = [
    Fault(
        "the record in the scene's place",
        "derive scene.mac --json scene.mac",
        message_of(ErrorKind.OUTPUT_TAKEN, "scene"),
    ),
    Fault(
        "the article in the scene's place",
        "derive scene.mac --tex ./scene.mac",
        message_of(ErrorKind.OUTPUT_TAKEN, "scene"),
    ),
    Fault(
        "the program in the scene's place",
        "program scene.mac --to python -o scene.mac",
        message_of(ErrorKind.OUTPUT_TAKEN, "scene"),
    ),
    Fault(
        "the library in the scene's place",
        "program scene.mac --to c -o scene.mac",
        message_of(ErrorKind.OUTPUT_TAKEN, "scene"),
    ),
    Fault(
        "the unit in the scene's place",
        "program scene.mac --to fmu -o scene.mac",
        message_of(ErrorKind.OUTPUT_TAKEN, "scene"),
    ),
    Fault(
        "the verdicts in the scene's place",
        "check scene.mac --json scene.mac --force",
        message_of(ErrorKind.OUTPUT_TAKEN, "scene"),
    ),
    Fault(
        "the scene by a symbolic link",
        "derive scene.mac --json link",
        message_of(ErrorKind.OUTPUT_TAKEN, "scene"),
        prepare=lambda here: (here / "link").symlink_to("scene.mac"),
    ),
    Fault(
        "the scene by a second name",
        "derive scene.mac --json hardlink",
        message_of(ErrorKind.OUTPUT_TAKEN, "scene"),
        prepare=lambda here: os.link(here / "scene.mac", here / "hardlink"),
    ),
    Fault(
        "the verdicts in a result's place",
        "check scene.mac --result result.json --json result.json",
        message_of(ErrorKind.OUTPUT_TAKEN, "result.json"),
        prepare=lambda here: (here / "result.json").write_text("{}"),
    ),
    Fault(
        "two outputs of one name", "derive scene.mac --json out --tex out", message_of(ErrorKind.OUTPUT_TAKEN, "output")
    ),
    Fault(
        "two outputs of one name, spelt apart",
        "derive scene.mac --json out --tex ./out",
        message_of(ErrorKind.OUTPUT_TAKEN, "output"),
    ),
    Fault(
        "two documents on standard output",
        "derive scene.mac --json - --tex -",
        message_of(ErrorKind.OUTPUT_TAKEN, "output"),
    ),
    Fault(
        "samples and figure of one name",
        "simulate scene.mac -o x.svg --plot x.svg",
        message_of(ErrorKind.OUTPUT_TAKEN, "output"),
    ),
    Fault("no such directory", "derive scene.mac --json nowhere/out.json", message_of(ErrorKind.UNWRITABLE)),
    Fault("a directory", "derive scene.mac --json .", message_of(ErrorKind.UNWRITABLE)),
    Fault("a file as a directory", "derive scene.mac --json scene.mac/out.json", message_of(ErrorKind.UNWRITABLE)),
    Fault("too long a name", f"derive scene.mac --json {'x' * 300}", message_of(ErrorKind.UNWRITABLE)),
    *(
        Fault(
            f"an unrelated {name}",
            f"{command} {name}",
            message_of(ErrorKind.UNRELATED_FILE),
            prepare=holding(name, content),
        )
        for name, command, content in (
            ("notes.json", "derive scene.mac --json", '{"name": "mine"}'),
            ("list.json", "check scene.mac --json", "[1, 2]"),
            ("other.mac", "derive scene.mac --json", PARTICLE),
            ("other.json", "derive scene.mac --json", '{"format": "holonom-thesis", "version": 2}'),
            ("table.csv", "simulate scene.mac -o", "name,mark\nme,1\n"),
            ("motion.csv", "simulate scene.mac -o", "t,x,dot(x)\n0,1,2\n"),
            ("drawing.svg", "errata --svg", "<svg xmlns='http://www.w3.org/2000/svg'/>"),
            ("thesis.tex", "derive scene.mac --tex", "\\documentclass{book}"),
            ("tool.py", "program scene.mac --to python -o", "print('mine')"),
        )
    ),
    Fault("an earlier document", "free scene.mac --json out.json", "", 0, holding("out.json", ENVELOPE)),
    Fault(
        "samples that may be replaced", "simulate scene.mac --until 1 -o x.csv --force", "", 0, holding("x.csv", "t\n")
    ),
    Fault("no such format", "simulate scene.mac --until 1 -o out.xls", message_of(ErrorKind.NO_SUCH_FORMAT)),
    Fault("a directory of others for the companion", "companion scene.mac -o .", message_of(ErrorKind.NOT_A_COMPANION)),
]

SCENES = [
    Fault("no such file", "derive nowhere.mac", message_of(ErrorKind.FILE_MISSING)),
    Fault("a directory as a scene", "derive .", message_of(ErrorKind.FILE_UNREADABLE)),
    Fault(
        "a pipe without a writer",
        "derive pipe",
        message_of(ErrorKind.FILE_UNREADABLE),
        prepare=lambda here: os.mkfifo(here / "pipe"),
    ),
    Fault("an endless device", "derive /dev/zero", message_of(ErrorKind.FILE_UNREADABLE)),
    Fault(
        message_of(ErrorKind.FILE_UNREADABLE),
        "derive null.mac",
        message_of(ErrorKind.FILE_UNREADABLE),
        prepare=holding("null.mac", b"x : 1$\0"),
    ),
    Fault(
        "a title in Latin-1",
        "derive latin.mac",
        message_of(ErrorKind.NOT_UTF8, "latin.mac:5", "0xe9"),
        prepare=holding("latin.mac", PARTICLE.replace("Particle", "Pärticlé").replace("ä", "a").encode("latin-1")),
    ),
    Fault(
        "UTF-16",
        "check wide.mac",
        message_of(ErrorKind.NOT_UTF8),
        prepare=holding("wide.mac", PARTICLE.encode("utf-16")),
    ),
    Fault(
        "a link to itself",
        "derive loop",
        message_of(ErrorKind.FILE_UNREADABLE),
        prepare=lambda here: (here / "loop").symlink_to("loop"),
    ),
    *(
        Fault(
            f"{call} on the way", "derive asks.mac", message_of(ErrorKind.QUESTION), prepare=holding("asks.mac", text)
        )
        for call, text in (
            ("break()", "x : 1$ break()$"),
            ("break(x)", 'break("why", x)$'),
            ("to_lisp()", "to_lisp()$"),
        )
    ),
    *(
        Fault(
            f"{name} defined anew",
            "derive anew.mac",
            message_of(None, f"anew.mac:{line}", name, whose),
            prepare=holding("anew.mac", PARTICLE + text),
        )
        for name, line, whose, text in (
            ("subst", 18, "Maxima's", "subst(a, b, c) := a$"),
            ("diff", 19, "Maxima's", "\nblock([x], define(diff(a, b), a))$"),
            ("map", 18, "Maxima's", "map([x]) ::= x$"),
            ("derive", 18, "Holonom's", "derive(x) := x$"),
            ("holonomic_scene", 18, "Holonom's", "holonomic_scene([x]) := x$"),
        )
    ),
    *(
        Fault(
            f"{entry} that is no text",
            "derive titled.mac",
            message_of(None, entry),
            prepare=holding(
                "titled.mac",
                PARTICLE.replace("kinetic_energy =", f"{entry} = u, kinetic_energy =").replace(
                    'title          = "Particle on a table of controlled height",', ""
                ),
            ),
        )
        for entry in ("title", "source")
    ),
    Fault(
        "a mass that no double holds",
        "simulate mass.mac --until 1",
        message_of(ErrorKind.NUMBER_TOO_LARGE),
        prepare=holding("mass.mac", PARTICLE.replace("m = 2", "m = 10^1000")),
    ),
    Fault(
        "an energy that is a truncated series",
        "derive series.mac --json out.json",
        "",
        0,
        holding("series.mac", PARTICLE.replace("m*g*z,", "m*g*taylor(sin(z), z, 0, 3),")),
    ),
    Fault(
        "names that are taken by no function",
        "derive own.mac --json out.json",
        "",
        0,
        holding(
            "own.mac", f"{PARTICLE}f(x) := x$ f(x) := 2*x$ A(x) := x$ energy(x) := x$ gradient(V) := V$ h(x) ::= x$"
        ),
    ),
    Fault(
        "a name of 100000 letters",
        "derive long.mac",
        message_of(ErrorKind.NAME_TOO_LONG, "long.mac:18"),
        prepare=holding("long.mac", f"{PARTICLE}x{'a' * 100_000} : 1$"),
    ),
    Fault(
        "a text of 100000 letters",
        "derive text.mac --json out.json",
        "",
        0,
        holding("text.mac", f'{PARTICLE}x : "{"a" * 100_000}"$'),
    ),
    Fault(
        "1001 scenes",
        "derive many.mac",
        message_of(ErrorKind.TOO_MANY_SCENES, "1001"),
        prepare=holding("many.mac", PARTICLE + "".join(f"s{k} : rise$ " for k in range(1000))),
    ),
    Fault(
        "a file of 70 MiB",
        "derive large.mac",
        message_of(ErrorKind.FILE_TOO_LARGE, "64 MiB"),
        prepare=holding("large.mac", b" " * (70 * 2**20)),
    ),
    Fault(
        "standard input without an end",
        "derive -",
        message_of(ErrorKind.FILE_TOO_LARGE, "standard input"),
        shell='"$@" < /dev/zero',
    ),
    Fault("an empty file", "derive empty.mac", message_of(ErrorKind.NOTHING_WRITTEN), prepare=holding("empty.mac", "")),
    Fault(
        "a file that ends Maxima",
        "derive quit.mac",
        message_of(ErrorKind.ENDED_EARLY),
        prepare=holding("quit.mac", "quit()$"),
    ),
    Fault(
        "a Maxima that is killed",
        "derive kill.mac",
        message_of(ErrorKind.KILLED, "SIGKILL"),
        MACHINE_AT_FAULT,
        prepare=holding("kill.mac", f'{SHELL} in_a_shell("kill -9 $PPID")$'),
    ),
    Fault(
        "a file that never ends",
        "derive loop.mac --time-limit 1",
        message_of(None, "--time-limit"),
        prepare=holding("loop.mac", "for i do 1$"),
    ),
    Fault(
        "an error without words",
        "derive error.mac",
        message_of(None, "error.mac:1"),
        prepare=holding("error.mac", 'error("")$'),
        long=True,
    ),
    Fault("lines ended as on Windows", DERIVE, "", 0, holding("scene.mac", PARTICLE.replace("\n", "\r\n"))),
    Fault("a byte order mark", DERIVE, "", 0, holding("scene.mac", "\ufeff" + PARTICLE), long=True),
    Fault("lines ended as on old Macs", DERIVE, "", 0, holding("scene.mac", PARTICLE.replace("\n", "\r")), long=True),
    *(
        Fault(f"a file named {name}", f"derive {name} --json out.json", "", 0, holding(name, PARTICLE), long=True)
        for name in ("a[1].mac", "*.mac", "what?.mac", "back\\slash.mac", 'quo"te.mac', "é.mac", "x;y.mac", "~.mac")
    ),
    Fault(
        "a name that is not UTF-8",
        "derive \udce9.mac --json out.json",
        "",
        0,
        lambda here: Path(os.fsdecode(os.fsencode(here) + b"/\xe9.mac")).write_text(PARTICLE),
        long=True,
    ),
]

ENVIRONMENTS = [
    Fault(
        "no Maxima",
        "derive scene.mac --trust",
        message_of(ErrorKind.MAXIMA_MISSING),
        MACHINE_AT_FAULT,
        environment=NO_PROGRAMS,
    ),
    Fault(
        "a Maxima that must not be executed",
        "derive scene.mac --trust",
        message_of(ErrorKind.MAXIMA_MISSING),
        MACHINE_AT_FAULT,
        maxima("#!/bin/sh\n", 0o644),
        {"PATH": "{here}/bin"},
    ),
    Fault(
        "a Maxima that is none",
        "derive scene.mac",
        message_of(ErrorKind.NOT_MAXIMA),
        MACHINE_AT_FAULT,
        maxima("not a program"),
        OTHER_MAXIMA,
    ),
    Fault(
        "a Maxima that says nothing",
        "derive scene.mac",
        message_of(ErrorKind.NOT_MAXIMA, "0"),
        MACHINE_AT_FAULT,
        maxima("#!/bin/sh\nexit 0\n"),
        OTHER_MAXIMA,
    ),
    Fault(
        "a Maxima that fails",
        "derive scene.mac",
        message_of(ErrorKind.NOT_MAXIMA, "7"),
        MACHINE_AT_FAULT,
        maxima("#!/bin/sh\necho garbage; exit 7\n"),
        OTHER_MAXIMA,
    ),
    *(
        Fault(name, "derive scene.mac", says, MACHINE_AT_FAULT, leaving(what, command), OTHER_MAXIMA)
        for name, what, command, says in (
            (
                "a truncated outcome",
                "outcome",
                "printf 'FINI' > {name}",
                message_of(ErrorKind.OUTPUT_TRUNCATED, "outcome"),
            ),
            ("an alien outcome", "outcome", "seq 100 > {name}", message_of(ErrorKind.OUTPUT_TRUNCATED, "outcome")),
            (
                "an outcome in bytes",
                "outcome",
                "head -c 9999 /dev/urandom > {name}",
                message_of(ErrorKind.OUTPUT_TRUNCATED, "outcome"),
            ),
            ("an outcome that is a directory", "outcome", "mkdir {name}", message_of(ErrorKind.NOT_MAXIMA)),
            ("an outcome that is a pipe", "outcome", "mkfifo {name}", message_of(ErrorKind.NOT_MAXIMA)),
            ("an outcome that is a link", "outcome", "ln -s /etc/passwd {name}", message_of(ErrorKind.NOT_MAXIMA)),
        )
    ),
    *(
        Fault(
            name, "derive scene.mac --trust", says, status, leaving("document", f"{command}; {FINISHED}"), OTHER_MAXIMA
        )
        for name, command, says, status in (
            ("no document", "true", message_of(ErrorKind.NOTHING_WRITTEN), 2),
            ("a document that is a directory", "mkdir {name}", message_of(ErrorKind.NOTHING_WRITTEN), 2),
            ("a document that is a link", "ln -s /etc/passwd {name}", message_of(ErrorKind.NOTHING_WRITTEN), 2),
            (
                "a truncated document",
                "printf '{{\"format\"' > {name}",
                message_of(ErrorKind.OUTPUT_TRUNCATED, "document"),
                MACHINE_AT_FAULT,
            ),
            ("an alien document", "echo hello > {name}", "", 2),
            ("a document of another kind", "echo '{{}}' > {name}", "", 2),
        )
    ),
    Fault(
        "no such directory for temporary files",
        DERIVE,
        "",
        0,
        environment={"TMPDIR": "{here}/scene.mac"},
    ),
    Fault(
        "standard output full",
        "derive scene.mac",
        message_of(None, os.strerror(errno.ENOSPC)),
        MACHINE_AT_FAULT,
        shell='"$@" > /dev/full',
    ),
    Fault("a full device", "derive scene.mac --json /dev/full", message_of(ErrorKind.DISK_FULL), MACHINE_AT_FAULT),
    Fault("no standard output", "derive scene.mac --json out.json", "", 0, shell='"$@" >&-', long=True),
    Fault("no standard error", DERIVE, "", 0, shell='"$@" 2>&-', long=True),
    Fault("no reader", "derive scene.mac", "", 141, shell='"$@" | true; exit ${PIPESTATUS[0]}'),
    Fault("no home", DERIVE, "", 0, environment={"HOME": ""}, long=True),
    Fault("a home that is not there", DERIVE, "", 0, environment={"HOME": "/nowhere"}, long=True),
    Fault("letters of ASCII alone", "derive scene.mac", "", 0, environment={"PYTHONIOENCODING": "ascii"}, long=True),
    # One of them is taken by libffi from 3.5 on.
    Fault("a dozen descriptors and one", "derive scene.mac --trust", "", 0, shell='ulimit -n 13; "$@"'),
    Fault("small files", DERIVE, "", MACHINE_AT_FAULT, shell='ulimit -f 4; "$@"'),
    Fault(
        "no bubblewrap where it is demanded",
        "derive scene.mac --sandbox",
        message_of(ErrorKind.NO_SANDBOX),
        MACHINE_AT_FAULT,
        environment=NO_PROGRAMS,
    ),
    *(
        Fault(f"CC={named}", "effects scene.mac", says, status, environment={"CC": named}, long=index > 0)
        for index, (named, says, status) in enumerate(
            (
                ("'", message_of(ErrorKind.COMPILER_UNUSABLE), MACHINE_AT_FAULT),
                ("true", message_of(ErrorKind.COMPILER_UNUSABLE), MACHINE_AT_FAULT),
                (" ", message_of(ErrorKind.COMPILER_UNUSABLE), MACHINE_AT_FAULT),
                ("false", message_of(ErrorKind.COMPILER_REFUSED), 2),
            )
        )
    ),
    Fault(
        "a compiler that hangs",
        "effects scene.mac --time-limit 30",
        message_of(None, "--time-limit"),
        prepare=executable("hangs", "#!/bin/sh\nexec sleep 1000\n"),
        environment={"CC": "{here}/hangs"},
        long=True,
    ),
    Fault(
        "settings of Matplotlib that are not UTF-8",
        "simulate scene.mac --until 1 --plot out.svg",
        message_of(None, "matplotlibrc"),
        prepare=holding("matplotlibrc", b"\xff\xfe"),
        shell='"$@"',  # Matplotlib reads them once a process
    ),
    Fault(
        "a Python without docstrings",
        "check scene.mac",
        message_of(None, "docstrings"),
        MACHINE_AT_FAULT,
        environment={"PYTHONOPTIMIZE": "2"},
    ),
    Fault(
        "a nonsensical backend of Matplotlib",
        "simulate scene.mac --until 1 --plot out.svg",
        "",
        0,
        environment={"MPLBACKEND": "nonsense"},
        long=True,
    ),
]

WORK = [
    Fault(
        "a billion samples", "simulate scene.mac --until 1 --samples 1000000000", message_of(ErrorKind.TOO_MANY_SAMPLES)
    ),
    Fault(
        "more samples than a disk holds",
        f"simulate scene.mac --until 1 --samples {10**15} -o x.csv",
        message_of(ErrorKind.DISK_TOO_SMALL),
    ),
    Fault(
        "a billion orders",
        "series scene.mac --order 1000000000",
        message_of(ErrorKind.REFUSED, "motion_series", "1000000000", "series_memory"),
        long=True,
    ),
    Fault(
        "a billion digits",
        "series scene.mac --order 4 --digits 1000000000",
        message_of(ErrorKind.REFUSED, "motion_series", "series_memory"),
        long=True,
    ),
    Fault(
        "a thousand digits",
        "simulate swing.mac --until 10 --precision 1000 --time-limit 8",
        message_of(None, "--time-limit"),
        prepare=holding("swing.mac", SWING),
        long=True,
    ),
    Fault(
        "an order of a million",
        "series scene.mac --order 1000000 --precision 50 --time-limit 8",
        message_of(None, "--time-limit"),
        long=True,
    ),
    Fault("a tolerance of nan", "simulate scene.mac --until 1 --tol nan", message_of(ErrorKind.TOLERANCE_OUT_OF_RANGE)),
    Fault(
        "a tolerance of zero",
        "simulate scene.mac --until 1 --tol 0",
        message_of(ErrorKind.TOLERANCE_OUT_OF_RANGE),
        long=True,
    ),
    *(
        Fault(f"a step of {text}", f"simulate scene.mac --until 1 --max-step {text}", says)
        for text, says in (
            ("nan", message_of(None, "--max-step", "nan")),
            ("inf", message_of(ErrorKind.NOT_A_STEP)),
            ("1e-300", message_of(ErrorKind.TOO_MANY_STEPS)),
        )
    ),
    *(
        Fault(
            f"a very late end, by {engine}",
            f"simulate swing.mac --until 99999999999999999999 --engine {engine}",
            message_of(kind),
            prepare=holding("swing.mac", SWING),
            long=engine == "robust",
        )
        for engine, kind in (
            ("taylor", ErrorKind.NO_WAY_ON),  # powers of the span, of the order of the expansion, overflow
            ("runge-kutta", ErrorKind.TOO_MANY_STEPS),
            ("robust", ErrorKind.TOO_MANY_STEPS),
        )
    ),
    Fault("an end before the start", "simulate scene.mac --until -1", message_of(ErrorKind.NOT_AFTER_START), long=True),
    Fault("5000 digits", "series scene.mac --order 4 --precision 5000", "", 0, long=True),
    Fault("one digit", "simulate scene.mac --until 1 --precision 1 --final", "", 0, long=True),
    Fault("an unused setting", "derive scene.mac --set k=1", message_of(None, "k"), long=True),
    Fault(
        "a law that ends within the time span",
        "simulate law.mac --until 1",
        message_of(ErrorKind.NO_WAY_ON, "0.5"),
        prepare=holding("law.mac", PARTICLE.replace("u = t]", "u = (1/2-t)^(5/2)]")),
        long=True,
    ),
    Fault(
        "a law that swings faster and faster",
        "simulate law.mac --until 1 --time-limit 20 --final",
        message_of(None, "--time-limit"),
        prepare=holding("law.mac", PARTICLE.replace("u = t]", "u = sin(1/(t-1/2))]")),
        long=True,
    ),
    Fault(
        "masses of opposite sign that cancel",
        "simulate negative.mac --until 1",
        message_of(None, "ddot(x)", "ddot(z)"),
        prepare=holding(
            "negative.mac", PARTICLE.replace("dot(x)^2 + dot(z)^2", "dot(x)^2 - dot(z)^2").replace("z - u", "z - x - u")
        ),
        long=True,
    ),
    Fault(
        "a motion that takes too long",
        "simulate swing.mac --until 1e9 --time-limit 20 --final",
        message_of(None, "--time-limit"),
        prepare=holding("swing.mac", SWING),
        long=True,
    ),
]


def abridged(rows: Iterable[Fault]) -> Iterator[Fault]:
    """The rows, and of those that differ in what is given alone only the first `SHORT` in the short form."""
    seen = Counter()
    for row in rows:
        seen[row.says, row.status] += 1
        yield replace(row, long=row.long or (bool(row.says) and seen[row.says, row.status] > SHORT))


TABLE = [*abridged([*OPTIONS, *OUTPUTS, *SCENES, *ENVIRONMENTS, *WORK])]
