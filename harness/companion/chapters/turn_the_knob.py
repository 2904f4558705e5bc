"""Page on which the reader sets the law and a script integrates the motion.

The script is made of motion programs of Maxima, written out as JavaScript: the motion, the constraints, the laws, the
drawing, and for each law what the accelerations are divided by, at complex times a + i b.
"""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from sympy import I, Symbol, jscode, simplify

from ...figures.style import text_with_symbols
from ...program.model import Model, scene_model
from ...program.motion_problem import motion_problem
from ...program.motion_program import Program
from ...program.request import Request
from ...program.targets import javascript
from ...sandbox import Limits
from .. import TEMPLATES
from ..cards import scene_named
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
        FILES: {"knob.js": _script(results["knob"], results["models"], *results["drawing"])},
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


def _script(found: Derived, models: Mapping[str, Model], shapes: Sequence[str], drawing: Program) -> str:
    """Return the script of the page: programs, laws, singular times, and its own part."""
    model = models["linear"]
    data = {"coordinates": model.coordinates, "until": UNTIL, "samples": SAMPLES, "shapes": shapes}
    singular = [f"{law}: {_singular(found, scene)}" for law, scene in LAWS.items()]
    return "\n".join(
        [
            javascript.write(model.motion, "motion"),
            javascript.write(model.constraints, "constraints"),
            javascript.write(drawing, "drawing"),
            *(javascript.write(each.law, f"law_{law}") for law, each in models.items()),
            f"const LAWS = {{{', '.join(f'{law}: law_{law}' for law in LAWS)}}};",
            f"const SINGULAR = {{{', '.join(singular)}}};",
            f"const DATA = {json.dumps(data)};",
            (TEMPLATES / "knob.js").read_text(encoding="utf-8"),
        ]
    )


def _singular(found: Derived, name: str) -> str:
    """Return a function of JavaScript for the denominator of (11) at time a + i b."""
    a, b, t = (Symbol(letter, real=True) for letter in ("a", "b", "t"))
    laws = scene_named(found, name).control_law.items()
    law = {Symbol(control, real=True): value.subs(t, a + I * b) for control, value in laws}
    parts = denominator(found).subs(law).expand(complex=True).as_real_imag()
    names = sorted({str(symbol) for part in parts for symbol in part.free_symbols})
    real, imaginary = (jscode(simplify(part)) for part in parts)
    return f"({{{', '.join(names)}}}) => ({{re: {real}, im: {imaginary}}})"


RUNS = {"models": Run(models, (TILTED_PLANE,)), "drawing": Run(_drawing_of, (TILTED_PLANE, LAWS["linear"]))}
