"""The commands about motion programs: program, effects."""

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

import click

from harness.cli.group import holonom
from harness.cli.options import STANDARD_OUTPUT, asks_one_scene, json_text, publish, runs_scenes, writes_json
from harness.confined import Limits


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
    publish(program_text(scene_file, request, Form(form), limits), output)
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
    from harness.console.costs import show_costs
    from harness.console.text import make_console
    from harness.motion.effects import measure_costs, read_costs
    from harness.motion.program import Solve
    from harness.motion.request import Request, effects_document, read_settings

    request = Request(scene, Solve(solve), read_settings(settings))
    costs = measure_costs(read_costs(effects_document(scene_file, request, limits)))
    publish(json_text(asdict(costs)), json_file)
    if json_file != STANDARD_OUTPUT:
        show_costs(make_console(), str(scene_file), costs)
    return 0
