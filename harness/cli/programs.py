"""The commands about motion programs: program, effects."""

from pathlib import Path

import click

from ..failures import ErrorKind, HolonomError
from ..options import options_of
from ..program.request import Request
from ..program.targets import FORMS, MODULES
from ..sandbox import Limits
from .group import holonom
from .options import asks_one_scene, present, publish, runs_scenes, writes_json
from .outputs import STANDARD_OUTPUT, OutputFile, is_forced


@holonom.command(
    examples=[
        "program examples/chain.mac --set N=64 --to python -o chain.py",
        "program examples/pendulum.mac --to c --parameters m -o pendulum/",
        "program examples/crane.mac --to python --module jax -o crane.py",
    ]
)
@asks_one_scene(*options_of(Request, "solve"))
@click.option(
    "--to",
    "form",
    type=click.Choice(FORMS),
    default="json",
    show_default=True,
    help="Format of the code.",
)
@click.option("--module", type=click.Choice(MODULES), help="Python package that the code uses, with --to python.")
@click.option(
    "--name",
    help="Name of the library or unit, for c, fmu, matlab and --module. Default: the name of the file.",
)
@click.option(
    "--parameters",
    metavar="NAME,...",
    callback=lambda ctx, parameter, text: tuple(text.split(",")) if text else (),
    help="Parameters that become inputs, for c, fmu, matlab and --module.",
)
@click.option(
    "-o",
    "--output",
    metavar="FILE|DIR",
    type=OutputFile(json=True, directory=True),
    default=STANDARD_OUTPUT,
    help="Destination: a directory for c, otherwise a file. Default: standard output.",
)
@runs_scenes
def program(
    scene_file: Path,
    request: Request,
    form: str,
    module: str | None,
    name: str | None,
    parameters: tuple[str, ...],
    output: Path,
    limits: Limits,
) -> int:
    """Write the motion as code.

    json, python and javascript contain the values of the scene. Controls are inputs, constant ones without derivatives.

    c is a C11 library: accelerations and multipliers, the control law, residuals and Jacobian of the constraints, and
    projection. fmu is the same for FMI 3 model exchange. Its parameters need values. matlab, and python with --module,
    are functions of arrays. Inputs are the controls, the parameters without a value, and those of --parameters.
    """
    from ..files import require_own_files, write_files, write_whole
    from ..program.forms import MotionProgram

    taken = MotionProgram(scene_file, request, limits)
    written = taken.written(form, name, parameters, module)
    if isinstance(written, str):
        publish(written, output)
    elif output == STANDARD_OUTPUT:
        raise HolonomError(ErrorKind.NOT_A_FILE)
    elif isinstance(written, bytes):
        write_whole(output, written)
    else:
        if not is_forced():
            require_own_files(output, written)
        write_files(output, written)
    return 0


@holonom.command(examples=["effects examples/crane.mac", "effects examples/crane.mac --json costs.json"])
@asks_one_scene(*options_of(Request, "solve"))
@writes_json
@runs_scenes
def effects(
    scene_file: Path,
    request: Request,
    json_file: Path | None,
    limits: Limits,
) -> int:
    """Measure what each term costs.

    The terms and effects of a SCENE are listed with their operations and measured times.
    """
    from ..display.measurements import show_costs
    from ..formats import Publication, published
    from ..program.effects import scene_costs

    costs = scene_costs(scene_file, request, limits)
    present(published(Publication.COSTS, costs), json_file, show_costs, costs)
    return 0
