"""The command line: derive, check, errata, program, effects, free, series.

Exit status: 0 when all is well, 1 when an equation disagrees, 2 for bad input, 130 when interrupted. Modules are
imported inside the commands: ``holonom --help`` waits for no SymPy.
"""

import functools
import json
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from harness.confined import Limits
from harness.failures import HolonomError

if TYPE_CHECKING:
    from harness.crosscheck import CheckReport
    from harness.free_motion import FreeMotion

DISAGREEMENT = 1
BAD_INPUT = 2
INTERRUPTED = 130
STANDARD_OUTPUT = Path("-")


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
    sys.exit(status)


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


def _instant(ctx: click.Context, parameter: click.Parameter, text: str | None) -> Fraction | None:
    """Read an instant: an integer, a decimal or a quotient of integers."""
    try:
        return None if text is None else Fraction(text)
    except (ValueError, ZeroDivisionError):
        raise click.BadParameter(f"{text} is no instant; write a number such as 0.75 or 3/4", ctx, parameter) from None


@holonom.command()
@click.argument("scene", type=click.Path(path_type=Path))
@takes_settings
@writes_json
@runs_scenes
def derive(scene: Path, settings: Sequence[str], json_file: Path | None, limits: Limits) -> int:
    """Derive the equations of a SCENE, under the paper's numbers."""
    from harness.console import make_console, show_record
    from harness.maxima import run_scene
    from harness.motion.request import read_settings
    from harness.record import read_record

    text = run_scene(scene, limits, read_settings(settings))
    record = read_record(text)
    _publish(text, json_file)
    if json_file != STANDARD_OUTPUT:
        show_record(make_console(), record)
    return 0


@holonom.command()
@click.argument("scenes", metavar="SCENE...", nargs=-1, required=True, type=click.Path(path_type=Path))
@takes_settings
@writes_json
@runs_scenes
def check(scenes: Sequence[Path], settings: Sequence[str], json_file: Path | None, limits: Limits) -> int:
    """Derive each SCENE and compare every equation with an independent SymPy evaluation."""
    from harness.console import make_console, show_report
    from harness.crosscheck import check_record
    from harness.maxima import run_scene
    from harness.motion.request import read_settings
    from harness.record import read_record

    given = read_settings(settings)
    reports = [(str(scene), check_record(read_record(run_scene(scene, limits, given)))) for scene in scenes]
    documents = [_report_document(scene, report) for scene, report in reports]
    _publish(_json_text(documents[0] if len(documents) == 1 else documents), json_file)
    if json_file != STANDARD_OUTPUT:
        console = make_console()
        for scene, report in reports:
            show_report(console, scene, report)
    return DISAGREEMENT if any(report.disagreements for _, report in reports) else 0


@holonom.command()
@writes_json
@click.option("--svg", "svg_file", metavar="FILE", type=click.Path(path_type=Path), help="Also draw the table.")
def errata(json_file: Path | None, svg_file: Path | None) -> int:
    """Compare every equation that the paper prints with the derived one."""
    from harness.console import draw_errata, make_console, show_errata
    from harness.errata import errata as compare

    equations = compare()
    _publish(_json_text({"equations": [asdict(equation) for equation in equations]}), json_file)
    if svg_file is not None:
        _publish(draw_errata(equations), svg_file)
    if json_file != STANDARD_OUTPUT:
        show_errata(make_console(), equations)
    return 0


@holonom.command()
@asks_one_scene
@click.option("--solve", type=click.Choice(["direct", "orthogonal"]), default="direct", show_default=True)
@click.option("--to", "form", type=click.Choice(["c", "python", "json"]), default="json", show_default=True)
@click.option("-o", "--output", metavar="FILE", type=click.Path(path_type=Path), default=STANDARD_OUTPUT)
@runs_scenes
def program(
    scene_file: Path,
    scene: str | None,
    settings: Sequence[str],
    solve: str,
    form: str,
    output: Path,
    limits: Limits,
) -> int:
    """Write the motion program of a SCENE, for those who carry it elsewhere."""
    from harness.motion.program import Solve
    from harness.motion.request import Form, Request, program_text, read_settings

    request = Request(scene, Solve(solve), read_settings(settings))
    _publish(program_text(scene_file, request, Form(form), limits), output)
    return 0


@holonom.command()
@asks_one_scene
@click.option("--solve", type=click.Choice(["direct", "orthogonal"]), default="direct", show_default=True)
@writes_json
@runs_scenes
def effects(
    scene_file: Path,
    scene: str | None,
    settings: Sequence[str],
    solve: str,
    json_file: Path | None,
    limits: Limits,
) -> int:
    """Show which terms and effects a SCENE has and what each costs, in operations and in measured time."""
    from harness.console import make_console, show_costs
    from harness.motion.effects import measure_costs, read_costs
    from harness.motion.program import Solve
    from harness.motion.request import Request, effects_document, read_settings

    request = Request(scene, Solve(solve), read_settings(settings))
    costs = measure_costs(read_costs(effects_document(scene_file, request, limits)))
    _publish(_json_text(asdict(costs)), json_file)
    if json_file != STANDARD_OUTPUT:
        show_costs(make_console(), str(scene_file), costs)
    return 0


@holonom.command()
@asks_one_scene
@writes_json
@runs_scenes
def free(scene_file: Path, scene: str | None, settings: Sequence[str], json_file: Path | None, limits: Limits) -> int:
    """Find when the motion of a SCENE is free: under its law, under which laws, under which for one trajectory."""
    from harness.console import make_console, show_free_motion
    from harness.free_motion import free_motion
    from harness.motion.request import read_settings

    found = free_motion(scene_file, scene, read_settings(settings), limits)
    _publish(_json_text(_free_motion_document(found)), json_file)
    if json_file != STANDARD_OUTPUT:
        show_free_motion(make_console(), found)
    return 0


@holonom.command()
@asks_one_scene
@click.option("--order", metavar="N", type=click.IntRange(min=2), required=True, help="Highest power of the time.")
@click.option("--exact", is_flag=True, help="Rational coefficients, or none; the default is exact where possible.")
@click.option("--digits", metavar="D", type=click.IntRange(min=1), help="Coefficients of D significant digits.")
@click.option("--precision", type=click.Choice(["double", "quadruple"]), help="Hardware numbers, by heyoka.")
@click.option("--at", metavar="T", callback=_instant, help="Also add the series up at the instant T.")
@click.option("--until", metavar="T", callback=_instant, help="Also continue the motion to T, beyond the radius.")
@writes_json
@runs_scenes
def series(
    scene_file: Path,
    scene: str | None,
    order: int,
    exact: bool,
    digits: int | None,
    precision: str | None,
    at: Fraction | None,
    until: Fraction | None,
    settings: Sequence[str],
    json_file: Path | None,
    limits: Limits,
) -> int:
    """Expand the initial motion of a SCENE in power series, and say how far they hold."""
    from harness.console import make_console, show_series
    from harness.motion import heyoka_series
    from harness.motion.request import read_settings
    from harness.motion.series import AUTOMATIC, EXACT, SeriesRequest, compute_series, series_document, values_at

    if sum([exact, digits is not None, precision is not None]) > 1:
        raise click.UsageError("--exact, --digits and --precision exclude one another")
    if precision and until is not None:
        raise click.UsageError("--until continues with digits, not with --precision")
    request = SeriesRequest(order, scene, EXACT if exact else digits or AUTOMATIC, until, read_settings(settings))
    if precision:
        motion = heyoka_series.compute_series(scene_file, request, heyoka_series.Precision(precision), limits)
    else:
        motion = compute_series(scene_file, request, limits)
    values = None if at is None else values_at(motion, at)
    _publish(_json_text(series_document(motion, values)), json_file)
    if json_file != STANDARD_OUTPUT:
        show_series(make_console(), motion, values)
    return 0


def _free_motion_document(found: "FreeMotion") -> dict[str, Any]:
    from harness.console import formula

    def law_text(law: Mapping[str, Any]) -> dict[str, str]:
        return {control: formula(value) for control, value in law.items()}

    verdict, universal, trajectory = found.verdict, found.universal, found.trajectory
    return {
        "scene": found.scene,
        "condition": [formula(each) for each in found.condition],
        "law": verdict
        and {
            "satisfies": verdict.satisfies,
            "residual": [formula(each) for each in verdict.residual] or None,
            "reason": verdict.reason,
        },
        "universal": {
            "laws": [law_text(law) for law in universal.laws],
            "unique": universal.unique,
            "reason": universal.reason,
        },
        "trajectory": {
            "law": law_text(trajectory.law) or None,
            "kind": trajectory.kind,
            "reason": trajectory.reason,
        },
    }


def _report_document(scene: str, report: "CheckReport") -> dict[str, Any]:
    return {
        "scene": scene,
        "equations": [
            {
                "number": found.number,
                "name": found.name,
                "scene_name": found.scene,
                "verdict": found.verdict,
                "digits": found.digits,
                "points": found.points,
                "detail": found.detail,
            }
            for found in report.verdicts
        ],
        "disagreements": report.disagreements,
    }


def _json_text(document: Any) -> str:
    return json.dumps(document, ensure_ascii=False, indent=1) + "\n"


def _publish(text: str, file: Path | None) -> None:
    """Put a document where an option asks for it, if it does."""
    if file == STANDARD_OUTPUT:
        click.echo(text, nl=False)
    elif file is not None:
        from harness.files import write_whole

        write_whole(file, text)


def _explain(error: HolonomError) -> None:
    for line in error.last_lines:
        click.echo(f"  | {line}", err=True)
    if error.command:
        click.echo(f"repeat it with: {error.command}", err=True)
