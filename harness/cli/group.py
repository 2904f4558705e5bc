"""The group of commands, their error messages and exit statuses.

Exit status: 0 for success, 1 if a check fails, 2 for bad input, 3 if the machine lacks something, 70 after an
internal error, 130 when interrupted, 141 if the reader of the output has ended.
"""

import io
import os
import sys
import warnings
from collections.abc import Collection, Sequence
from contextlib import nullcontext, suppress
from typing import Any

import click

from ..extras import naming_the_extra
from ..failures import MACHINE, HolonomError, HolonomWarning
from ..hidden import visible
from ..supervisor import supervise
from .outputs import STANDARD_INPUT, Command

INTERNAL_ERROR = 70
INTERRUPTED = 130
PIPE_CLOSED = 141
NO_DOCSTRINGS = "this Python has no docstrings, which libraries read; run it without -OO and PYTHONOPTIMIZE."
OWN_PROCESS = object()  # what a command finds in its context when nothing else runs in its process


class Commands(click.Group):
    """The commands, with every error reported in one message."""

    command_class = Command

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command. Return its exit status.

        Parameters
        ----------
        ctx : Context
            Context of the group.

        Returns
        -------
        object
            Exit status of the command, as listed above.
        """
        verbose = ctx.params["verbose"]
        try:
            with naming_the_extra():
                return super().invoke(ctx)
        except (HolonomError, ExceptionGroup) as error:
            errors = error.exceptions if isinstance(error, ExceptionGroup) else (error,)
            if not all(isinstance(each, HolonomError) for each in errors):
                return _internal_error(error, verbose)
            standing_in = str(ctx.meta.get(STANDARD_INPUT, ""))
            return max(_rejected(each, verbose, self._options(ctx), standing_in) for each in errors)
        except BrokenPipeError:
            return PIPE_CLOSED
        except MemoryError:
            return _report("not enough memory. Reduce the problem.", MACHINE)
        except OSError as error:
            return _system_error(error)
        except (click.ClickException, click.Abort, click.exceptions.Exit):
            raise
        except Exception as error:
            if sys.flags.optimize > 1:
                return _report(NO_DOCSTRINGS, MACHINE)
            return _internal_error(error, verbose)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command, or raise an error that suggests a similar name.

        Parameters
        ----------
        ctx : Context
            Context of the group.
        args : list of str
            Words of the command line, the name of the command first.

        Returns
        -------
        name : str or None
            Name of the command.
        command : Command or None
            The command.
        rest : list of str
            The other words.

        Raises
        ------
        click.UsageError
            No command has this name.
        """
        try:
            return super().resolve_command(ctx, args)
        except click.UsageError:
            from difflib import get_close_matches

            near = get_close_matches(args[0], self.list_commands(ctx))
            raise click.UsageError(f"No such command '{args[0]}'.{_meant(near)}", ctx) from None

    def _options(self, ctx: click.Context) -> set[str]:
        """Options of the command that runs."""
        command = self.get_command(ctx, ctx.invoked_subcommand or "")
        return {option for parameter in (command.params if command else ()) for option in parameter.opts}


@click.group(cls=Commands)
@click.option("-v", "--verbose", is_flag=True, help="On failure, show Maxima's last lines and how to repeat the run.")
@click.option("-q", "--quiet", is_flag=True, help="Print only errors, and output to `-`.")
@click.option(
    "--version",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=lambda *arguments: _print_versions(*arguments),
    help="Show the versions of Holonom, Maxima, its Lisp, heyoka and SymPy.",
)
def holonom(verbose: bool, quiet: bool) -> None:
    """Derive, check and simulate holonomic systems with redundant coordinates.

    A SCENE is a Maxima file that describes a system and what to do with it.
    """


def _print_versions(ctx: click.Context, parameter: click.Parameter, wanted: bool) -> None:
    if wanted and not ctx.resilient_parsing:
        from ..installation import versions

        for name, version in versions().items():
            click.echo(f"{name} {version}")
        ctx.exit()


def main() -> None:
    """Run the command line and leave with its exit status."""
    # For `holonom.simulation.evaluation.one_blas_thread`. NumPy reads this at its first import.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    os.environ.pop("MPLBACKEND", None)  # figures go to files; Matplotlib fails to load where this is nonsense
    _open_what_is_closed()
    try:
        status = supervise(run)
    except HolonomError as error:
        status = _report(error.message(), error.kind.status)
    except OSError as error:  # as where no process may be started
        status = _system_error(error)
    sys.stderr.flush()
    os._exit(status)  # the child has written all there is to write


def run() -> int:
    """Run the command line in this process. Return its exit status.

    Every error is reported in one message.

    Returns
    -------
    int
        Exit status, as listed above.
    """
    _write_what_can_be_written()
    warnings.showwarning = _show_warning
    try:
        status = holonom(standalone_mode=False, obj=OWN_PROCESS) or 0
        with suppress(OSError) if status == MACHINE else nullcontext():  # reported already
            sys.stdout.flush()
        return status
    except click.ClickException as error:
        message = _message_of(error)
        return _report(message if message.endswith(("?", ".")) else f"{message}.", error.exit_code)
    except (click.Abort, KeyboardInterrupt):
        return INTERRUPTED
    except (BrokenPipeError, SystemExit):  # with which rich and click leave where the reader is gone
        return PIPE_CLOSED
    except OSError as error:
        return _system_error(error)


def _message_of(error: click.ClickException) -> str:
    """Return a message that begins with the option or argument that it is about."""
    match error:
        case click.NoSuchOption():
            return f"{error.message}.{_meant(sorted(error.possibilities or ()))}"
        case click.BadParameter(param=click.Parameter() as parameter) if not isinstance(error, click.MissingParameter):
            spelt = [each for each in parameter.opts if each.startswith("--")]
            return f"{spelt[0] if spelt else parameter.human_readable_name}: {error.message}"
    return error.format_message()


def _meant(names: Sequence[str]) -> str:
    return f" Did you mean {' or '.join(names)}?" if names else ""


def _show_warning(message: Warning | str, category: type[Warning], filename: str, lineno: int, *more: Any) -> None:
    """Print a warning about a scene file as one line, any other as Python does."""
    if issubclass(category, HolonomWarning):
        click.echo(f"holonom: warning: {visible(str(message))}", err=True)
    else:
        sys.stderr.write(warnings.formatwarning(message, category, filename, lineno))


def _open_what_is_closed() -> None:
    """Open the null device in place of closed standard streams.

    Otherwise the next file would take their number.
    """
    while (descriptor := os.open(os.devnull, os.O_RDWR)) <= 2:
        pass
    os.close(descriptor)
    sys.stdin = sys.stdin or os.fdopen(0, "r")
    sys.stdout = sys.stdout or os.fdopen(1, "w")
    sys.stderr = sys.stderr or os.fdopen(2, "w")


def _write_what_can_be_written() -> None:
    """Write characters that standard output or error cannot encode by their codes."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def _report(message: str, status: int) -> int:
    click.echo(f"holonom: error: {' '.join(visible(message).splitlines())}", err=True)
    return status


def _system_error(error: OSError) -> int:
    what = f"{error.filename}: {error.strerror}" if error.filename else error.strerror or str(error)
    return _report(f"the operating system reports: {what}.", MACHINE)


def _rejected(error: HolonomError, verbose: bool, options: Collection[str], standing_in: str) -> int:
    """Report an error, without the name of the temporary copy of standard input."""
    named = "standard input"
    _report(error.message(options).replace(standing_in or named, named), error.kind.status)
    if verbose:
        for line in error.last_lines:
            click.echo(f"  | {visible(line)}", err=True)
        if error.command:
            click.echo(f"repeat it with: {visible(error.command)}", err=True)
    return error.kind.status


def _internal_error(error: Exception, verbose: bool) -> int:
    what = " ".join(f"{type(error).__name__}: {error}".split())
    _report(f"an internal error, {what}; please report it with the output of `holonom -v ...`.", INTERNAL_ERROR)
    if verbose:
        import traceback

        traceback.print_exception(error)
    return INTERNAL_ERROR
