"""What several commands share: options, and documents put where an option asks for them."""

import functools
import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..hidden import visible
from ..sandbox import UNCONFINED, Limits, Sandbox, is_isolated
from ..supervisor import EXPECTED, limit_time
from .outputs import STANDARD_OUTPUT, OutputFile, SceneFile

if TYPE_CHECKING:
    from fractions import Fraction

DISAGREEMENT = 1  # exit status where SymPy contradicts Maxima
SHOWN = 40  # letters of an option that is refused
LONGEST = 1e9  # seconds of a time limit: 30 years
MOST_MEMORY = 2**30  # MiB of a memory limit


def writes_json(command: Callable[..., int]) -> Callable[..., int]:
    """Give a command the option --json."""
    return click.option(
        "--json",
        "json_file",
        metavar="FILE|-",
        type=OutputFile(json=True),
        help="Also write the result to FILE as one JSON document; with -, write nothing but that to standard output.",
    )(command)


def takes_settings(command: Callable[..., int]) -> Callable[..., int]:
    """Give a command the option --set."""
    return click.option(
        "--set",
        "settings",
        metavar="NAME=VALUE",
        multiple=True,
        callback=_read_settings,
        help="A number that the file leaves open.",
    )(command)


def _read_settings(ctx: click.Context, parameter: click.Parameter, texts: tuple[str, ...]) -> dict[str, str]:
    from ..program.request import read_settings

    return read_settings(texts)


def chooses_solve(command: Callable[..., int]) -> Callable[..., int]:
    """Give a command the option --solve."""
    return click.option(
        "--solve",
        type=click.Choice(["direct", "orthogonal"]),
        default="direct",
        show_default=True,
        help="How the multipliers are solved for; orthogonal keeps more digits near singular configurations.",
    )(command)


def asks_one_scene(command: Callable[..., int]) -> Callable[..., int]:
    """Give a command a scene file, and as its `request` a scene in it, numbers for what is open, and the solve."""

    @functools.wraps(command)
    def asked(*, scene: str | None, settings: dict[str, str], solve: str = "direct", **options: Any) -> int:
        from ..program.motion_program import Solve
        from ..program.request import Request

        return command(request=Request(scene, Solve(solve), settings), **options)

    asked = takes_settings(asked)
    asked = click.option("--scene", metavar="NAME", help="The scene in the file; without it, the last one.")(asked)
    return click.argument("scene_file", metavar="SCENE", type=SceneFile())(asked)


def runs_scenes(command: Callable[..., int]) -> Callable[..., int]:
    """Give a command the options that limit and isolate its runs, passed on as `limits`."""
    defaults = Limits()

    @click.option(
        "--time-limit",
        metavar="SECONDS",
        type=float,
        callback=_read_seconds,
        help=f"Time for the whole command; without it, {defaults.seconds:g} s for each run of Maxima, and nothing in "
        f"many digits that takes longer than {EXPECTED:g} s.",
    )
    @click.option(
        "--memory-limit",
        metavar="MIB",
        type=click.IntRange(256, MOST_MEMORY),
        default=defaults.memory_mib,
        show_default=True,
        help="Memory that Maxima may take for a scene.",
    )
    @click.option("--trust", is_flag=True, help="Run the scene file outside the sandbox: it may do what you may do.")
    @click.option("--sandbox", is_flag=True, help="Refuse to run a scene file on a machine without a sandbox.")
    @click.option(
        "--allow",
        metavar="FILE",
        multiple=True,
        type=click.Path(exists=True, dir_okay=False, path_type=Path),
        help="Let the scene read this file in the sandbox. May be given several times.",
    )
    @functools.wraps(command)
    def limited(
        *,
        time_limit: float | None,
        memory_limit: int,
        trust: bool,
        sandbox: bool,
        allow: tuple[Path, ...],
        **options: Any,
    ) -> int:
        if time_limit is not None:
            limit_time(time_limit)
        limits = Limits(time_limit or defaults.seconds, memory_limit, sandbox=_sandbox(trust, sandbox), allow=allow)
        return command(limits=limits, **options)

    return limited


def _read_seconds(ctx: click.Context, parameter: click.Parameter, seconds: float | None) -> float | None:
    if seconds is not None and not 0 < seconds <= LONGEST:
        raise click.BadParameter(f"{seconds:g} is no time; give seconds, more than 0 and at most {LONGEST:g}")
    return seconds


def _sandbox(trust: bool, sandbox: bool) -> Sandbox:
    """Return when the scene runs in the sandbox; print one line if this machine has none and nobody asked for that."""
    if trust and sandbox:
        raise click.UsageError("--trust and --sandbox exclude one another")
    if trust:
        return Sandbox.TRUSTED
    wanted = Sandbox.REQUIRED if sandbox else Sandbox.WHERE_POSSIBLE
    if not is_isolated(Limits(sandbox=wanted)):
        click.echo(f"holonom: {UNCONFINED}", err=True)
    return wanted


def read_instant(ctx: click.Context, parameter: click.Parameter, text: str | None) -> "Fraction | None":
    """Read an instant: an integer, a decimal or a quotient of integers."""
    from fractions import Fraction

    from ..program.request import within_reach

    if text is None:
        return None
    try:
        if not within_reach(text):
            raise OverflowError
        return Fraction(text)
    except (ValueError, ZeroDivisionError, OverflowError):
        shown = text if len(text) <= SHOWN else f"{text[:SHOWN]}..."
        raise click.BadParameter(
            f"{shown} is no instant; write a number such as 0.75 or 3/4, of a size that a double can have",
            ctx,
            parameter,
        ) from None


def json_text(document: Any) -> str:
    """A document as `--json` writes it."""
    return json.dumps(document, ensure_ascii=False, indent=1) + "\n"


def present(document: Any, json_file: Path | None, show: Callable[..., None], *shown: Any) -> None:
    """Put a document where --json asks for it, and show a result on the console unless the document is there."""
    publish(json_text(document), json_file)
    if json_file != STANDARD_OUTPUT:
        from .console import make_console

        show(make_console(), *shown)


def publish(text: str, file: Path | None) -> None:
    """Put a document where an option asks for it, if it does."""
    if file == STANDARD_OUTPUT:
        click.echo(visible(text) if sys.stdout.isatty() else text, nl=False)
    elif file is not None:
        from ..files import write_whole

        write_whole(file, text)
