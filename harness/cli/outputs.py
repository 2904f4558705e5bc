"""The files that a command reads and writes; no output takes the place of a scene, of another output, or of a stranger.

What is there is replaced with --force alone, or where it is a JSON document of Holonom's and another takes its place.
"""

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import click

from ..failures import Failure, HolonomError
from ..files import require_writable, scene_file
from ..temporary import private_directory

STANDARD_OUTPUT = Path("-")
STANDARD_INPUT = "holonom.standard_input"  # where it holds the file that stands in for standard input
FORCE = "holonom.force"  # where the context of a command holds whether it has the option


class SceneFile(click.Path):
    """A scene file; ``-`` is what stands on standard input, kept in a file of its own while the command runs."""

    name = "scene"

    def __init__(self) -> None:
        super().__init__(path_type=Path)

    def convert(self, value: Any, parameter: click.Parameter | None, ctx: click.Context | None) -> Path:
        """Return the path of the file."""
        if value != str(STANDARD_OUTPUT) or ctx is None:
            return scene_file(super().convert(value, parameter, ctx))
        from ..maxima import limited

        file = Path(ctx.with_resource(private_directory()), "standard_input.mac")
        file.write_bytes(limited(click.get_binary_stream("stdin"), "standard input"))
        ctx.meta[STANDARD_INPUT] = file
        return file


def as_given(scene: Path) -> str:
    """Return how the command line names a scene file: ``-`` where it stands on standard input."""
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
    """A command that looks at its outputs before it begins.

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
                click.Option(["--force"], is_flag=True, help="Replace files, and not only Holonom's own documents.")
            )

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the command's own options, then those that it has in common with others, then the examples."""
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
        """Refuse outputs that would destroy something or cannot be written; then run the command."""
        given = [(each.type, ctx.params.get(each.name)) for each in self.params]
        outputs = [(kind, path) for kind, path in given if isinstance(kind, OutputFile) and path is not None]
        scenes = [path for kind, value in given if isinstance(kind, SceneFile) for path in _paths(value)]
        force = ctx.meta[FORCE] = ctx.params.pop("force", False)
        files = [(kind, path) for kind, path in outputs if path != STANDARD_OUTPUT]
        for kind, path in files:
            if not (kind.directory and path.is_dir()):
                require_writable(path)
        require_apart(scenes, [path for _, path in outputs])
        for kind, path in () if force else files:
            require_replaceable(path, kind.json)
        return super().invoke(ctx)


def is_forced() -> bool:
    """Return True if the running command may replace what is somebody else's."""
    return click.get_current_context().meta.get(FORCE, False)


def require_apart(scenes: Iterable[Path], outputs: Iterable[Path]) -> None:
    """Refuse an output that is a scene of the command, or another output, also through links."""
    taken = [(scene, "the scene itself") for scene in scenes]
    for output in outputs:
        for other, what in taken:
            if _same_file(output, other):
                raise HolonomError(Failure.OUTPUT_TAKEN, output, what)
        taken.append((output, "another output"))


def require_replaceable(path: Path, json: bool) -> None:
    """Refuse to replace a file, unless it is empty, or a document of Holonom's in the place of which another is put.

    Raises
    ------
    HolonomError
        There is a file with something else in it.
    """
    from ..formats import is_document

    if path.is_file() and path.stat().st_size and not (json and is_document(path.read_bytes())):
        raise HolonomError(Failure.FOREIGN_FILE, path)


def _paths(value: Any) -> tuple[Path, ...]:
    return value if isinstance(value, tuple) else (value,)


def _same_file(output: Path, other: Path) -> bool:
    if STANDARD_OUTPUT in (output, other):
        return output == other
    if output.exists() and other.exists():
        return os.path.samefile(output, other) and (output.is_file() or output.is_dir())
    return output.resolve() == other.resolve()
