"""Options that several commands share, and output of documents by an option."""

import functools
import json
import sys
from collections.abc import Callable
from dataclasses import Field
from fractions import Fraction
from pathlib import Path
from typing import Any

import click

from ..failures import HolonomError
from ..hidden import visible
from ..options import choices_of, kind_of, options_of, read, read_time
from ..program.request import Request, read_settings
from ..sandbox import UNSANDBOXED, Limits, Sandbox, is_isolated
from ..supervisor import EXPECTED, limit_time
from .outputs import STANDARD_OUTPUT, OutputFile, SceneFile

FAILED = 1  # exit status of a check that fails, and of a result that is none
LONGEST = 1e9  # seconds of a time limit: 30 years
MOST_MEMORY = 2**30  # MiB of a memory limit


class IntegerRange(click.IntRange):
    """An integer between bounds, which messages call so."""

    name = "integer"


def writes_json(command: Callable[..., int]) -> Callable[..., int]:
    """Give a command the option --json.

    Parameters
    ----------
    command : callable
        Function with an argument `json_file`.

    Returns
    -------
    callable
        The function with the option.
    """
    return click.option(
        "--json",
        "json_file",
        metavar="FILE|-",
        type=OutputFile(json=True),
        help="Write the result as JSON to FILE. With -, print JSON instead of the tables.",
    )(command)


def takes_settings(command: Callable[..., int]) -> Callable[..., int]:
    """Give a command the options --set and --closed-form-size.

    Parameters
    ----------
    command : callable
        Function with an argument `settings`, names with their values as text.

    Returns
    -------
    callable
        The function with the options.
    """

    @click.option(
        "--set",
        "settings",
        metavar="NAME=VALUE",
        multiple=True,
        callback=_read_settings,
        help="Set a parameter, or a variable of the scene file. May be repeated.",
    )
    @click.option(
        "--closed-form-size",
        metavar="N",
        type=IntegerRange(1),
        help="Largest closed form, in terms. Default: closed_form_size of the scene file, or 500.",
    )
    @functools.wraps(command)
    def called(*, settings: dict[str, str], closed_form_size: int | None, **options: Any) -> int:
        size = {} if closed_form_size is None else {"closed_form_size": str(closed_form_size)}
        return command(settings=settings | size, **options)

    return called


def _read_settings(ctx: click.Context, parameter: click.Parameter, texts: tuple[str, ...]) -> dict[str, str]:
    return read_settings(texts)


def takes(*taken: Field, name: str = "options") -> Callable[[Callable[..., int]], Callable[..., int]]:
    """Give a command options that are fields of requests.

    It takes their values as one mapping of that name.

    Parameters
    ----------
    *taken : Field
        Fields that become options.
    name : str
        Name of the argument that gets the values.

    Returns
    -------
    callable
        Decorator of a function that has this argument.
    """

    def decorate(command: Callable[..., int]) -> Callable[..., int]:
        @functools.wraps(command)
        def called(**given: Any) -> int:
            values = {each.name: read(each, given.pop(each.name)) for each in taken}
            return command(**{name: values}, **given)

        for each in reversed(taken):
            called = _click_option(each)(called)
        return called

    return decorate


def _click_option(each: Field) -> Callable[[Callable[..., int]], Callable[..., int]]:
    stated, kind = each.metadata["option"], kind_of(each)
    written = "--" + each.name.replace("_", "-")
    former = [f"--{stated.alias}"] if stated.alias else []
    names = (*(stated.spelt or [written]), *former, each.name)
    choices, details = choices_of(each), {}
    if choices:
        details["type"] = click.Choice(choices)
    elif kind is Fraction:
        details["callback"] = as_time
    elif kind is bool and each.default is None:
        names = (f"{written}/--no-{written[2:]}", each.name)
    elif kind is bool:
        details["is_flag"] = True
    elif kind in (int, float) and not stated.least is stated.most is stated.above is None:
        bound = IntegerRange if kind is int else click.FloatRange
        least, is_open = (stated.least, False) if stated.above is None else (stated.above, True)
        details["type"] = bound(least, stated.most, min_open=is_open)
    elif kind in (int, float):
        details["type"] = kind
    default = None if stated.required or kind is tuple else each.default
    return click.option(
        *names,
        metavar=stated.metavar,
        default=str(default) if choices and default is not None else default,
        show_default=default not in (None, False),
        required=stated.required,
        help=stated.help,
        **details,
    )


def asks_one_scene(*taken: Field) -> Callable[[Callable[..., int]], Callable[..., int]]:
    """Give a command a scene file and the fields of a request about one scene.

    Its `request` has a scene of the file, values of open names, and the other fields.

    Parameters
    ----------
    *taken : Field
        Further fields of the request that become options.

    Returns
    -------
    callable
        Decorator of a function with arguments `scene_file` and `request`.
    """

    def decorate(command: Callable[..., int]) -> Callable[..., int]:
        @functools.wraps(command)
        def asked(*, settings: dict[str, str], chosen: dict[str, Any], **more: Any) -> int:
            return command(request=Request(settings=settings, **chosen), **more)

        asked = takes(*options_of(Request, "scene"), *taken, name="chosen")(takes_settings(asked))
        return click.argument("scene_file", metavar="SCENE", type=SceneFile())(asked)

    return decorate


def runs_scenes(command: Callable[..., int]) -> Callable[..., int]:
    """Give a command the options that limit and sandbox its runs.

    It takes them as `limits`.

    Parameters
    ----------
    command : callable
        Function with an argument `limits`.

    Returns
    -------
    callable
        The function with the options.
    """
    defaults = Limits()

    @click.option(
        "--time-limit",
        metavar="SECONDS",
        type=float,
        callback=_read_seconds,
        help=f"Time limit for the whole command. Default: {defaults.seconds:g} s for each run of Maxima, and "
        f"{EXPECTED:g} s for computations in many digits.",
    )
    @click.option(
        "--memory-limit",
        metavar="MIB",
        type=IntegerRange(256, MOST_MEMORY),
        default=defaults.memory_mib,
        show_default=True,
        help="Memory limit of a Maxima run.",
    )
    @click.option("--trust", is_flag=True, help="Run the scene file without a sandbox, with your permissions.")
    @click.option("--sandbox", is_flag=True, help="Fail if the sandbox is not available.")
    @click.option(
        "--allow",
        metavar="FILE",
        multiple=True,
        type=click.Path(exists=True, dir_okay=False, path_type=Path),
        help="Let the scene read this file in the sandbox. May be repeated.",
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
        raise click.BadParameter(f"expected seconds above 0 and up to {LONGEST:g}, not {seconds:g}.")
    return seconds


def _sandbox(trust: bool, sandbox: bool) -> Sandbox:
    """Return the use of the sandbox that the options ask for.

    Print one line if this machine has no sandbox and no option asks for one.
    """
    if trust and sandbox:
        raise click.UsageError("--trust and --sandbox exclude each other")
    if trust:
        return Sandbox.TRUSTED
    wanted = Sandbox.REQUIRED if sandbox else Sandbox.WHERE_POSSIBLE
    if not is_isolated(Limits(sandbox=wanted)):
        click.echo(f"holonom: warning: {UNSANDBOXED}", err=True)
    return wanted


def as_time(ctx: click.Context, parameter: click.Parameter, text: str | None) -> Fraction | None:
    """Read a time (a callback of Click).

    Parameters
    ----------
    ctx : Context
        Context of the command.
    parameter : Parameter
        Option that gives the time.
    text : str or None
        The time, a decimal number or a quotient.

    Returns
    -------
    Fraction or None
        None without the option.

    Raises
    ------
    click.BadParameter
        The text is not a time.
    """
    try:
        return None if text is None else read_time(text)
    except HolonomError as error:
        raise click.BadParameter(error.message(), ctx, parameter) from None


def json_text(document: Any) -> str:
    """Return a document as `--json` writes it.

    Parameters
    ----------
    document : object
        Content that JSON can hold.

    Returns
    -------
    str
        Text with a newline at its end.
    """
    return json.dumps(document, ensure_ascii=False, indent=1) + "\n"


def present(document: Any, json_file: Path | None, show: Callable[..., None], *shown: Any) -> None:
    """Write a document to the output that --json names, and show a result.

    The result is not shown if the document goes to standard output.

    Parameters
    ----------
    document : object
        Content that JSON can hold.
    json_file : Path or None
        File that --json names. ``-`` is standard output, or None without the option.
    show : callable
        Function that prints the result. Its first argument is the console.
    *shown : object
        Further arguments of the function.
    """
    publish(json_text(document), json_file)
    if json_file != STANDARD_OUTPUT:
        from .console import make_console

        show(make_console(), *shown)


def publish(text: str, file: Path | None) -> None:
    """Write a document to the output that an option names, if any.

    Parameters
    ----------
    text : str
        The whole document.
    file : Path or None
        File to write. ``-`` is standard output, or None for no output.
    """
    if file == STANDARD_OUTPUT:
        click.echo(visible(text) if sys.stdout.isatty() else text, nl=False)
    elif file is not None:
        from ..files import write_whole

        write_whole(file, text)
