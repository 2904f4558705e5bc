"""The group of commands, with bad input explained in one sentence."""

import gc
import sys
from typing import Any

import click

from ..failures import HolonomError

BAD_INPUT = 2
INTERRUPTED = 130


class Commands(click.Group):
    """The commands, with bad input explained in one sentence."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command asked for; return its exit status."""
        try:
            return super().invoke(ctx)
        except HolonomError as error:
            click.echo(f"holonom: {error}", err=True)
            if ctx.params["verbose"]:
                _explain(error)
            return BAD_INPUT


@click.group(cls=Commands)
@click.option("-v", "--verbose", is_flag=True, help="On failure show Maxima's last lines and how to repeat the run.")
@click.version_option(package_name="holonom")
def holonom(verbose: bool) -> None:
    """Controllable holonomic systems with redundant coordinates, derived by Maxima and checked by SymPy.

    A SCENE is a Maxima file that describes a system and what to do with it.
    """


def main() -> None:
    """Run the command line and leave with its exit status."""
    try:
        status = holonom(standalone_mode=False)
    except click.ClickException as error:
        error.show()
        status = error.exit_code
    except click.Abort:
        status = INTERRUPTED
    gc.freeze()  # modules need no search for garbage on the way out: it takes three times as long as all the rest
    sys.exit(status)


def _explain(error: HolonomError) -> None:
    for line in error.last_lines:
        click.echo(f"  | {line}", err=True)
    if error.command:
        click.echo(f"repeat it with: {error.command}", err=True)
