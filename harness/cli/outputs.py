"""The files that a command reads and writes; no output takes the place of a scene, of another output, or of a stranger.

What is there is replaced without --force only where it is an earlier output of the same kind, which is told by how it
begins or ends.
"""

import os
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import click

from ..failures import Failure, HolonomError
from ..files import draft_of, private_directory, scene_file

STANDARD_OUTPUT = Path("-")
LOOKED_AT = 16384  # bytes at each end of a file
STANDARD_INPUT = "holonom.standard_input"  # where it holds the file that stands in for standard input
FORCE = "holonom.force"  # where the context of a command holds whether it has the option

# What the beginning and the end of an earlier output hold, by kind.
EARLIER = {
    "json": re.compile(rb'\A\s*(\[\s*)?\{\s*"format"\s*:\s*"holonom-'),
    "tex": re.compile(rb"\A% Written by Holonom\n"),
    "svg": re.compile(rb"\A\s*(<\?xml|<svg).*(Holonom|class=\"errata|rich-terminal)", re.DOTALL),
    "png": re.compile(rb"\A\x89PNG\r\n.*Holonom", re.DOTALL),
    "pdf": re.compile(rb"\A%PDF-.*Skia/PDF", re.DOTALL),
    "csv": re.compile(rb"\At(,[^,\n]+)*\n"),
    "npz": re.compile(rb"\APK\x03\x04.{26,60}t\.npy", re.DOTALL),
    "parquet": re.compile(rb"\APAR1.*holonom", re.DOTALL),
    "python": re.compile(rb'\A"""Motion program( of |: )'),
    "javascript": re.compile(rb"\A/\* Motion program( of |: )"),
    "fmu": re.compile(rb"\APK\x03\x04.*modelDescription\.xml", re.DOTALL),
}


class SceneFile(click.Path):
    """A scene file; ``-`` is what stands on standard input, kept in a file of its own while the command runs."""

    name = "scene"

    def __init__(self) -> None:
        super().__init__(path_type=Path)

    def convert(self, value: Any, parameter: click.Parameter | None, ctx: click.Context | None) -> Path:
        """The path of the file."""
        if value != str(STANDARD_OUTPUT) or ctx is None:
            return scene_file(super().convert(value, parameter, ctx))
        file = Path(ctx.with_resource(private_directory()), "standard_input.mac")
        file.write_bytes(click.get_binary_stream("stdin").read())
        ctx.meta[STANDARD_INPUT] = file
        return file


def as_given(scene: Path) -> str:
    """How the command line names a scene file: ``-`` where it stands on standard input."""
    stands_in = scene == click.get_current_context().meta.get(STANDARD_INPUT)
    return str(STANDARD_OUTPUT if stands_in else scene)


class OutputFile(click.Path):
    """The name of a file that a command writes.

    Parameters
    ----------
    kinds : str
        What it may hold, keys of `EARLIER`; or c, a directory of files that a manifest lists.
    """

    def __init__(self, *kinds: str) -> None:
        super().__init__(path_type=Path)
        self.kinds = kinds


class Command(click.Command):
    """A command that looks at its outputs before it begins."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        if any(isinstance(each.type, OutputFile) for each in self.params):
            self.params.append(click.Option(["--force"], is_flag=True, help="Replace files that are somebody else's."))

    def invoke(self, ctx: click.Context) -> Any:
        """Refuse outputs that would destroy something or cannot be written; then run the command."""
        given = [(each.type, ctx.params.get(each.name)) for each in self.params]
        outputs = [(kind, path) for kind, path in given if isinstance(kind, OutputFile) and path is not None]
        scenes = [path for kind, value in given if isinstance(kind, SceneFile) for path in _paths(value)]
        force = ctx.meta[FORCE] = ctx.params.pop("force", False)
        files = [(kind.kinds, path) for kind, path in outputs if path != STANDARD_OUTPUT]
        for kinds, path in files:
            require_writable(path, kinds)
        require_apart(scenes, [path for _, path in outputs])
        if not force:
            for kinds, path in files:
                require_earlier_output(path, kinds)
        return super().invoke(ctx)


def is_forced() -> bool:
    """Whether the running command may replace what is somebody else's."""
    return click.get_current_context().meta.get(FORCE, False)


def require_apart(scenes: Iterable[Path], outputs: Iterable[Path]) -> None:
    """Refuse an output that is a scene of the command, or another output, also through links."""
    taken = [(scene, "the scene itself") for scene in scenes]
    for output in outputs:
        for other, what in taken:
            if _same_file(output, other):
                raise HolonomError(Failure.OUTPUT_TAKEN, output, what)
        taken.append((output, "another output"))


def require_writable(path: Path, kinds: Iterable[str]) -> None:
    """Refuse an output that cannot be written, before there is anything to write.

    Raises
    ------
    HolonomError
        It is a directory, or nothing can be put beside it.
    """
    try:
        target = path.resolve()
        if target.is_dir():
            if "c" in kinds:
                return
            raise IsADirectoryError(None, "it is a directory")
        if not target.exists() or target.is_file():
            with draft_of(target) as draft:
                draft.touch()
    except OSError as error:
        raise HolonomError(Failure.UNWRITABLE, path, error.strerror or str(error)) from None


def require_earlier_output(path: Path, kinds: Iterable[str]) -> None:
    """Refuse to replace what is no earlier output of one of these kinds, keys of `EARLIER`.

    Raises
    ------
    HolonomError
        There is a file with something else in it.
    """
    if not path.is_file() or path.stat().st_size == 0:
        return
    with path.open("rb") as file:
        ends = file.read(LOOKED_AT)
        file.seek(max(file.tell(), path.stat().st_size - LOOKED_AT))
        ends += file.read()
    if not any(EARLIER[kind].search(ends) for kind in kinds if kind in EARLIER):
        raise HolonomError(Failure.FOREIGN_FILE, path)


def _paths(value: Any) -> tuple[Path, ...]:
    return value if isinstance(value, tuple) else (value,)


def _same_file(output: Path, other: Path) -> bool:
    if STANDARD_OUTPUT in (output, other):
        return output == other
    if output.exists() and other.exists():
        return os.path.samefile(output, other) and (output.is_file() or output.is_dir())
    return output.resolve() == other.resolve()
