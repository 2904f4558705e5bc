"""The commands that derive and compare: derive, check, errata."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..failures import HolonomError
from ..language import ENGLISH, LANGUAGES, speaking
from ..sandbox import Limits
from ..supervisor import doing, time_to_limit
from .background import run_in_background
from .group import holonom
from .options import FAILED, present, publish, runs_scenes, takes_settings, writes_json
from .outputs import STANDARD_OUTPUT, OutputFile, SceneFile, as_given

if TYPE_CHECKING:
    from ..crosscheck.report import CheckReport, EquationVerdict
    from ..crosscheck.results import Content
    from ..record import Record
    from ..source import Source

TIME_TO_TELL = 1.0  # seconds reserved for the verdicts found within a time limit


@holonom.command(examples=["describe examples/pendulum.mac", "describe examples/pendulum.mac --json pendulum.json"])
@click.argument("scene", type=SceneFile())
@takes_settings
@writes_json
@runs_scenes
def describe(scene: Path, settings: dict[str, str], json_file: Path | None, limits: Limits) -> int:
    """Show the description in a SCENE file.

    Nothing is derived. Commands accept the document that --json writes in place of a SCENE.
    """
    from ..display.description import show_description
    from ..source import describe as describe_file

    description = describe_file(scene, settings, limits)
    present(description.content, json_file, show_description, description)
    return 0


@holonom.command(examples=["derive examples/pendulum.mac", "derive examples/pendulum.mac --tex pendulum.tex"])
@click.argument("scene", type=SceneFile())
@takes_settings
@writes_json
@click.option("--tex", "tex_file", metavar="FILE|-", type=OutputFile(), help="Write a LaTeX document.")
@runs_scenes
def derive(
    scene: Path,
    settings: dict[str, str],
    json_file: Path | None,
    tex_file: Path | None,
    limits: Limits,
) -> int:
    """Derive the equations of motion.

    The equations have the numbers of the paper, (1) to (19).
    """
    from ..display.derivation import show_record
    from ..documents import ask
    from ..formats import Document
    from ..record import read_record
    from .console import make_console

    text = ask(Document.RECORD, scene, settings=settings, limits=limits)
    record = read_record(text)
    _publish_document(record, tex_file)
    publish(text, json_file)
    if STANDARD_OUTPUT not in (json_file, tex_file):
        show_record(make_console(), record)
    return 0


@holonom.command(examples=["check examples/pendulum.mac", "check examples/arm.mac --json -"])
@click.argument("scenes", metavar="SCENE...", nargs=-1, required=True, type=SceneFile())
@takes_settings
@writes_json
@click.option("--seed", metavar="TEXT", help="Repeat the random points of an earlier check, which printed this seed.")
@click.option(
    "--result",
    "result_files",
    metavar="FILE",
    multiple=True,
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Also check a JSON result of linearize, linearize-along, equilibria or series. May be repeated.",
)
@click.option("--allow-undecided", is_flag=True, help="Exit with status 0 if something is undecided.")
@runs_scenes
def check(
    scenes: Sequence[Path],
    settings: dict[str, str],
    json_file: Path | None,
    seed: str | None,
    result_files: Sequence[Path],
    allow_undecided: bool,
    limits: Limits,
) -> int:
    """Check the derivation with SymPy.

    Every equation, program and series of each SCENE is compared with an independent SymPy evaluation. The exit status
    is 1 if one disagrees or could not be decided. If a SCENE is invalid, it is 2, and the others are checked.
    """
    from ..crosscheck.report import Verdict
    from ..crosscheck.seed import fresh_seed
    from ..display.derivation import show_reports
    from ..source import Source

    if result_files and len(scenes) > 1:
        raise click.UsageError("--result needs one SCENE")
    results = _read_results(result_files)
    seed = seed or fresh_seed()
    reports, errors = [], []
    for scene in scenes:
        try:
            reports.append((as_given(scene), _checked(Source(scene, limits), settings, seed, results)))
        except HolonomError as error:
            errors.append(error)
    documents = [_report_document(scene, report) for scene, report in reports]
    if documents:
        present(documents[0] if len(scenes) == 1 else documents, json_file, show_reports, reports)
    if errors:
        raise ExceptionGroup("scenes without a check", errors)
    unwanted = (Verdict.DISAGREES,) if allow_undecided else (Verdict.DISAGREES, Verdict.UNDECIDED)
    return FAILED if any(report.count(*unwanted) for _, report in reports) else 0


def _checked(source: "Source", settings: dict[str, str], seed: str, results: Sequence["Content"]) -> "CheckReport":
    """Check one scene file, its motions with its equations."""
    from ..record import derived_record
    from .beside import beside, result_of

    with beside(_verify_motions, settings, seed) as child:
        with run_in_background(source.file, source.limits, _import_what_checks):
            description = source.description(settings)
            child.send(source)
            record = derived_record(source, settings)

        from ..crosscheck.check import check_record
        from ..crosscheck.motions import verdicts_out_of_time
        from ..crosscheck.results import verify_result

        with doing("checking with SymPy"):
            report = check_record(record, description, seed, time_to_limit() - TIME_TO_TELL)
            motions = result_of(child, time_to_limit() - TIME_TO_TELL, verdicts_out_of_time(description))
    return report.with_verdicts([*motions, *(verify_result(description, each) for each in results)])


def _read_results(files: Sequence[Path]) -> list["Content"]:
    if not files:
        return []
    from ..crosscheck.results import read_result

    return [read_result(file) for file in files]


def _verify_motions(source: "Source", settings: dict[str, str], seed: str) -> list["EquationVerdict"]:
    """Ask Maxima for the motions of a source, and verify them."""
    from ..crosscheck.questions import ask_for_check

    with run_in_background(source.file, source.limits, _import_verification):
        asked = ask_for_check(source, settings)

    from ..crosscheck.motions import motion_verdicts, read_motions

    description = source.description(settings)
    return list(motion_verdicts(description, read_motions(description, asked), seed, time_to_limit() - TIME_TO_TELL))


def _import_what_checks() -> None:
    """Import SymPy and the modules of the check."""
    from ..crosscheck import check, lagranges_method, motions  # noqa: F401
    from ..display import derivation  # noqa: F401


def _import_verification() -> None:
    """Import the modules that read and verify motions."""
    from ..crosscheck import motions  # noqa: F401
    from ..program import drawing  # noqa: F401


@holonom.command(examples=["errata", "errata --language zh --svg errata.svg"])
@writes_json
@click.option("--svg", "svg_file", metavar="FILE", type=OutputFile(), help="Draw the table.")
@click.option(
    "--language",
    type=click.Choice(list(LANGUAGES)),
    default=ENGLISH,
    show_default=True,
    help="Language of the table.",
)
def errata(json_file: Path | None, svg_file: Path | None, language: str) -> int:
    """Compare the printed with derived equations.

    Every equation printed in the paper is compared with the derived one.
    """
    from ..display.derivation import draw_errata, show_errata
    from ..errata import Errata
    from ..errata import errata as compare
    from ..formats import Document, published

    equations = compare()
    with speaking(language):
        present(published(Document.ERRATA, Errata(equations)), json_file, show_errata, equations)
        if svg_file is not None:
            publish(draw_errata(equations), svg_file)
    return 0


def _publish_document(record: "Record", tex_file: Path | None) -> None:
    if tex_file is not None:
        from ..typeset.document import tex_document

        publish(tex_document(record), tex_file)


def _report_document(scene: str, report: "CheckReport") -> dict[str, Any]:
    from ..crosscheck.report import CheckedFile
    from ..display.derivation import why_left_out
    from ..formats import Publication, published

    verdicts = (
        replace(each, detail=why_left_out(each.left_out)) if each.left_out else each for each in report.verdicts
    )
    return published(Publication.CHECK, CheckedFile(scene, replace(report, verdicts=tuple(verdicts))))
