"""The command that makes the textbook: companion."""

from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path

import click

from ..extras import missing_package
from ..language import ENGLISH, LANGUAGES
from ..sandbox import Limits
from .group import holonom
from .options import runs_scenes, takes_settings
from .outputs import OutputFile, SceneFile

EXTRAS = (
    "jinja2",
    "babel",
    "latex2mathml",
    "matplotlib",
    "heyoka",
    "pypdf",
    "sphinx",
    "myst_parser",
    "furo",
    "sphinxcontrib.bibtex",
)


@holonom.command(examples=["companion -o build/companion", "companion examples/pendulum.mac -o pages"])
@click.argument("scenes", metavar="[SCENE...]", nargs=-1, type=SceneFile())
@click.option(
    "-o",
    "--output",
    "directory",
    metavar="DIR",
    required=True,
    type=click.Path(path_type=Path),
    help="Directory of the pages; open index.html first.",
)
@click.option("--pdf", type=OutputFile(), help="Print all pages to one PDF, by Chromium.")
@click.option(
    "--language",
    "languages",
    multiple=True,
    type=click.Choice(list(LANGUAGES)),
    help="Language of the pages. Default: en. May be repeated; further languages go to subdirectories.",
)
@takes_settings
@runs_scenes
def companion(
    scenes: Sequence[Path],
    directory: Path,
    pdf: Path | None,
    languages: Sequence[str],
    settings: dict[str, str],
    limits: Limits,
) -> int:
    """Make the textbook, or pages of a SCENE.

    Without a SCENE, make the textbook companion of the paper, otherwise pages about each SCENE.
    """
    for package in EXTRAS:
        if find_spec(package) is None:
            raise missing_package(package)
    from ..companion.chapter import chapters_of_the_paper
    from ..companion.own_scenes import chapters_of_scenes
    from ..companion.site import make_site
    from ..display.progress import progress
    from .console import make_console

    given = tuple(settings.items())
    if given and not scenes:
        raise click.UsageError("--set and --closed-form-size need a SCENE")
    chapters = chapters_of_scenes(scenes, given, limits) if scenes else chapters_of_the_paper()
    runs = {run for chapter in chapters.values() for run in chapter.runs.values()}
    with progress(f"Making {directory}", len(runs)) as done:
        make_site(scenes, chapters, directory, pdf, tuple(dict.fromkeys(languages)) or (ENGLISH,), done)
    done_line = f"The companion is in {directory}: open {directory / 'index.html'} in a browser."
    make_console().print(done_line, soft_wrap=True)
    return 0
