"""What several commands share: options, and documents put where an option asks for them."""

import functools
import json
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import click

from ..confined import Limits

STANDARD_OUTPUT = Path("-")


def writes_json(command: Callable[..., int]) -> Callable[..., int]:
    """Give a command the option --json."""
    return click.option(
        "--json",
        "json_file",
        metavar="FILE|-",
        type=click.Path(path_type=Path),
        help="Also write the result to FILE as one JSON document; with -, write nothing but that to standard output.",
    )(command)


def takes_settings(command: Callable[..., int]) -> Callable[..., int]:
    """Give a command the option --set."""
    return click.option(
        "--set", "settings", metavar="NAME=VALUE", multiple=True, help="A number that the file leaves open."
    )(command)


def asks_one_scene(command: Callable[..., int]) -> Callable[..., int]:
    """Give a command a scene file, the name of a scene in it, and numbers for what the file leaves open."""
    command = takes_settings(command)
    command = click.option("--scene", metavar="NAME", help="The scene in the file; without it, the last one.")(command)
    return click.argument("scene_file", metavar="SCENE", type=click.Path(path_type=Path))(command)


def runs_scenes(command: Callable[..., int]) -> Callable[..., int]:
    """Give a command the options that limit its Maxima runs, passed on as `limits`."""
    defaults = Limits()

    @click.option(
        "--time-limit",
        metavar="SECONDS",
        type=click.FloatRange(min=0, min_open=True),
        default=defaults.seconds,
        show_default=True,
        help="Time that Maxima may take for a scene.",
    )
    @click.option(
        "--memory-limit",
        metavar="MIB",
        type=click.IntRange(min=256),
        default=defaults.memory_mib,
        show_default=True,
        help="Memory that Maxima may take for a scene.",
    )
    @functools.wraps(command)
    def limited(*, time_limit: float, memory_limit: int, **options: Any) -> int:
        return command(limits=Limits(seconds=time_limit, memory_mib=memory_limit), **options)

    return limited


def read_instant(ctx: click.Context, parameter: click.Parameter, text: str | None) -> Fraction | None:
    """Read an instant: an integer, a decimal or a quotient of integers."""
    try:
        return None if text is None else Fraction(text)
    except (ValueError, ZeroDivisionError):
        raise click.BadParameter(f"{text} is no instant; write a number such as 0.75 or 3/4", ctx, parameter) from None


def json_text(document: Any) -> str:
    """A document as `--json` writes it."""
    return json.dumps(document, ensure_ascii=False, indent=1) + "\n"


def publish(text: str, file: Path | None) -> None:
    """Put a document where an option asks for it, if it does."""
    if file == STANDARD_OUTPUT:
        click.echo(text, nl=False)
    elif file is not None:
        from ..files import write_whole

        write_whole(file, text)
