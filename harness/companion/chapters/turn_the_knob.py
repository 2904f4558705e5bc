"""Page on which the reader sets the law and a script integrates the motion.

The script is made of motion programs of Maxima, written out as JavaScript: the motion, the constraints, the laws, the
drawing, and for each law what the accelerations are divided by, at complex times a + i b.
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import sympy
from sympy import I, Symbol

from ...figures.style import text_with_symbols
from ...mathjson import from_sympy
from ...program.model import Model, scene_model
from ...program.motion_problem import motion_problem
from ...program.motion_program import Program
from ...program.request import Request
from ...program.targets import javascript
from ...record import Scene
from ...sandbox import Limits
from .. import TEMPLATES
from ..cards import named_equations, scene_named
from ..chapter import FILES
from ..runs import Derived, Run
from . import TILTED_PLANE
from .radius_of_convergence import denominator

LAWS = {"linear": "linear_scene", "exponential": "exponential_scene", "swinging": "swinging_scene"}
OPEN = ("u0", "k", "c")
OF_LAW = {"linear": (), "exponential": ("kappa",), "swinging": ("omega",)}  # parameters of one law alone
UNTIL, SAMPLES = 4.0, 201


def page(results: Mapping[str, Any]) -> dict[str, Any]:
    """Return values of the page.

    Parameters
    ----------
    results : mapping
        Results of the runs by their names.

    Returns
    -------
    dict
        Values by name.
    """
    return {
        "values": {name: value for model in results["models"].values() for name, value in model.values.items()},
        "samples": SAMPLES,
        "law_of": lambda motion: text_with_symbols(motion.title.rpartition(", ")[2]),
        FILES: {"knob.js": script(results["knob"], results["models"], results["drawing"])},
    }


def models(file: Path) -> dict[str, Model]:
    """Return the scenes as models whose parameters are open, by law.

    Parameters
    ----------
    file : Path
        Scene file.

    Returns
    -------
    dict of str to Model
        Models by control law.
    """
    return {law: scene_model(file, Request(scene), [*OPEN, *OF_LAW[law]], Limits()) for law, scene in LAWS.items()}


def _drawing_of(file: Path, scene: str) -> tuple[tuple[str, ...], Program]:
    """Return the shapes of the system's drawing, and the program of their numbers."""
    drawing = motion_problem(file, Request(scene), Limits()).drawing
    return tuple(map(str, drawing.shapes)), drawing.program


def script(found: Derived, models: Mapping[str, Model], drawing: tuple[tuple[str, ...], Program]) -> str:
    """Return the script of the page.

    Parameters
    ----------
    found : Derived
        Derivation of the example.
    models : mapping of str to Model
        Models by control law.
    drawing : tuple
        Kinds of the drawn parts, and their program.

    Returns
    -------
    str
        JavaScript.
    """
    _require_free_law(found)
    shapes, program = drawing
    model = models["linear"]
    data = {
        "coordinates": model.coordinates,
        "until": UNTIL,
        "samples": SAMPLES,
        "shapes": shapes,
    }
    parts = [
        javascript.write(model.motion, "motion"),
        javascript.write(model.constraints, "constraints"),
        javascript.write(program, "drawing"),
        *(javascript.write(each.law, f"law_{law}") for law, each in models.items()),
        *(javascript.write(_singular(found, scene), f"singular_{law}") for law, scene in LAWS.items()),
        f"const LAWS = {{{', '.join(f'{law}: law_{law}' for law in LAWS)}}};",
        f"const SINGULAR = {{{', '.join(f'{law}: singular_{law}' for law in LAWS)}}};",
        f"const DATA = {json.dumps(data)};",
        (TEMPLATES / "knob.js").read_text(encoding="utf-8"),
    ]
    return "\n".join(parts)


def _require_free_law(found: Derived) -> None:
    """Raise unless the multiplier vanishes under u0 exp(kappa t), kappa^2 = k."""
    multiplier = named_equations(found)["multipliers"].relations[0].right
    kappa, k, c, u, rate, second = (Symbol(name, real=True) for name in ("kappa", "k", "c", "u", "dot(u)", "ddot(u)"))
    free = {second: kappa**2 * u, rate: kappa * u, k: kappa**2, c: 2 * kappa}
    if sympy.simplify(multiplier.subs(free)) != 0:
        raise ValueError("the exponential law does not make every motion free")


def _singular(found: Derived, name: str) -> Program:
    """Return real and imaginary part of the denominator of (11) at time a + i b."""
    scene: Scene = scene_named(found, name)
    a, b, t = (Symbol(letter, real=True) for letter in ("a", "b", "t"))
    law = {Symbol(control, real=True): value.subs(t, a + I * b) for control, value in scene.control_law.items()}
    real, imaginary = denominator(found).subs(law).expand(complex=True).as_real_imag()
    parts = {"re": sympy.simplify(real), "im": sympy.simplify(imaginary)}
    inputs = sorted({str(symbol) for part in parts.values() for symbol in part.free_symbols} | {"a", "b"})
    return Program.of_document(
        {
            "format": "holonom-program",
            "version": 2,
            "scene": name,
            "solve": "direct",
            "method": "singular times",
            "redundant": [],
            "operations": sum(int(part.count_ops()) for part in parts.values()),
            "inputs": inputs,
            "assignments": [[f"w_{part}", from_sympy(value)] for part, value in parts.items()],
            "outputs": {part: f"w_{part}" for part in parts},
        }
    )


RUNS = {"models": Run(models, (TILTED_PLANE,)), "drawing": Run(_drawing_of, (TILTED_PLANE, LAWS["linear"]))}
