"""Input and output files of commands, with checks against overwriting files.

An existing file is replaced only with --force, or if it is a JSON document of Holonom and another one takes its
place.
"""

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import click

from ..failures import ErrorKind, HolonomError
from ..files import require_writable, scene_file
from ..language import translatable
from ..temporary import private_directory

STANDARD_OUTPUT = Path("-")
STANDARD_INPUT = "holonom.standard_input"  # where it holds the file that stands in for standard input
FORCE = "holonom.force"  # where the context of a command holds whether it has the option


class SceneFile(click.Path):
    """The type of a scene file, where ``-`` is standard input.

    Standard input is stored in a temporary file while the command runs.
    """

    name = "scene"

    def __init__(self) -> None:
        super().__init__(path_type=Path)

    def convert(self, value: Any, parameter: click.Parameter | None, ctx: click.Context | None) -> Path:
        """Return the path of the file.

        Parameters
        ----------
        value : object
            Path on the command line.
        parameter : Parameter or None
            Argument of the command.
        ctx : Context or None
            Context that removes the temporary file.

        Returns
        -------
        Path
        """
        if value != str(STANDARD_OUTPUT) or ctx is None:
            return scene_file(super().convert(value, parameter, ctx))
        from ..maxima import limited

        file = Path(ctx.with_resource(private_directory()), "standard_input.mac")
        file.write_bytes(limited(click.get_binary_stream("stdin"), "standard input"))
        ctx.meta[STANDARD_INPUT] = file
        return file


def as_given(scene: Path) -> str:
    """Return the name of a scene file on the command line.

    It is ``-`` for standard input.

    Parameters
    ----------
    scene : Path
        Path of the scene file, or of the copy of standard input.

    Returns
    -------
    str
    """
    stands_in = scene == click.get_current_context().meta.get(STANDARD_INPUT)
    return str(STANDARD_OUTPUT if stands_in else scene)


class OutputFile(click.Path):
    """The name of a file that a command writes.

    Parameters
    ----------
    json : bool
        Whether it is a document in JSON.
    directory : bool
        Whether it may be a directory of files that a manifest lists.
    """

    def __init__(self, *, json: bool = False, directory: bool = False) -> None:
        super().__init__(path_type=Path)
        self.json, self.directory = json, directory


COMMON = {"scene", "settings", "json_file", "time_limit", "memory_limit", "trust", "sandbox", "allow", "force", "help"}


class Command(click.Command):
    """A command that checks its outputs before it begins.

    Parameters
    ----------
    examples : sequence of str
        Commands that its help shows, without ``holonom``.
    """

    def __init__(self, *arguments: Any, examples: Sequence[str] = (), **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.examples = tuple(examples)
        if any(isinstance(each.type, OutputFile) for each in self.params):
            self.params.append(
                click.Option(["--force"], is_flag=True, help="Overwrite existing files, whatever they contain.")
            )

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the command's own options, then the common options, then the examples.

        Parameters
        ----------
        ctx : Context
            Context of the command.
        formatter : HelpFormatter
            Collects the text of the help page.
        """
        common = [each for each in self.get_params(ctx) if each.name in COMMON]
        own = [each for each in self.get_params(ctx) if each not in common]
        for title, options in (("Options", own), ("Common options", common)):
            rows = [row for each in options if (row := each.get_help_record(ctx)) is not None]
            if rows:
                with formatter.section(title):
                    formatter.write_dl(rows)
        if self.examples:
            with formatter.section("Examples"):
                for each in self.examples:
                    formatter.write(f"{'':{formatter.current_indent}}holonom {each}\n")

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command, after a check of its outputs.

        Parameters
        ----------
        ctx : Context
            Context with the values of all options.

        Returns
        -------
        object
            Exit status.

        Raises
        ------
        HolonomError
            An output cannot be written, replaces an unrelated file, or is an input or another output.
        """
        given = [(each.type, ctx.params.get(each.name)) for each in self.params]
        outputs = [(kind, path) for kind, path in given if isinstance(kind, OutputFile) and path is not None]
        scenes = [path for kind, value in given if isinstance(kind, SceneFile) for path in _paths(value)]
        inputs = [path for kind, value in given if getattr(kind, "exists", False) for path in _paths(value or ())]
        force = ctx.meta[FORCE] = ctx.params.pop("force", False)
        files = [(kind, path) for kind, path in outputs if path != STANDARD_OUTPUT]
        for kind, path in files:
            if not (kind.directory and path.is_dir()):
                require_writable(path)
        require_apart(scenes, [path for _, path in outputs], inputs)
        for kind, path in () if force else files:
            _require_replaceable(path, kind.json)
        return super().invoke(ctx)


def is_forced() -> bool:
    """Return True if the running command may replace unrelated files.

    Returns
    -------
    bool
    """
    return click.get_current_context().meta.get(FORCE, False)


def require_apart(scenes: Iterable[Path], outputs: Iterable[Path], inputs: Iterable[Path] = ()) -> None:
    """Raise if an output is an input of the command or another output.

    Links are followed.

    Parameters
    ----------
    scenes : iterable of Path
        Scene files that the command reads.
    outputs : iterable of Path
        Files that the command writes.
    inputs : iterable of Path
        Other files that it reads.

    Raises
    ------
    HolonomError
        An output is also an input or another output.
    """
    taken = [(scene, translatable("the scene itself")) for scene in scenes]
    taken += [(each, translatable("an input")) for each in inputs]
    for output in outputs:
        for other, what in taken:
            if _same_file(output, other):
                raise HolonomError(ErrorKind.OUTPUT_TAKEN, output, what)
        taken.append((output, translatable("another output")))


def _require_replaceable(path: Path, json: bool) -> None:
    """Raise if a file may not be replaced.

    An empty file may be, and a document of Holonom by another one.
    """
    from ..formats import is_document

    if path.is_file() and path.stat().st_size and not (json and is_document(path.read_bytes())):
        raise HolonomError(ErrorKind.UNRELATED_FILE, path)


def _paths(value: Any) -> tuple[Path, ...]:
    return value if isinstance(value, tuple) else (value,)


def _same_file(output: Path, other: Path) -> bool:
    if STANDARD_OUTPUT in (output, other):
        return output == other
    if output.exists() and other.exists():
        return os.path.samefile(output, other) and (output.is_file() or output.is_dir())
    return output.resolve() == other.resolve()
