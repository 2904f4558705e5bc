"""Turn the knob: a page on which the reader sets the law, and a script follows the motion.

The script is made of motion programs of Maxima, written out as JavaScript: the motion, the constraints, the laws, the
drawing, and for each law what the accelerations are divided by, at complex instants a + i b.
"""

import json
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

import sympy
from sympy import I, Symbol

from ...figures.curves import Panel, draw_curves
from ...figures.style import lettered_text
from ...free_motion import Free, FreeMotion
from ...language import gettext
from ...mathjson import from_sympy
from ...program.model import Model, scene_model
from ...program.motion_problem import motion_problem
from ...program.motion_program import Program
from ...program.request import Request
from ...program.targets import javascript
from ...record import Scene
from ...sandbox import Limits
from .. import TEMPLATES
from ..cards import scene_named
from ..chapter import Page, Run
from ..power import energy_balance
from ..runs import Derived, derived, free, simulation
from . import KNOB
from .radius_of_convergence import denominator

LAWS = {"linear": "linear_scene", "exponential": "exponential_scene", "swinging": "swinging_scene"}
OPEN = ("u0", "omega", "c")
UNTIL, SAMPLES = Fraction(4), 201
UNDAMPED = (("c", "1"),)  # a damping other than the paper's


def runs(root: Path) -> dict[str, Run]:
    """Return what the chapter needs."""
    file = root / KNOB
    return {
        "knob": derived(file),
        "models": Run(models, (file,)),
        "drawing": Run(drawing_of, (file, LAWS["linear"])),
        "free": free(file, LAWS["exponential"]),
        "other": free(file, LAWS["exponential"], UNDAMPED),
        **{law: simulation(file, scene, UNTIL, SAMPLES) for law, scene in LAWS.items()},
    }


def page(root: Path, results: Mapping[str, Any]) -> Page:
    """Return the page that results make."""
    found = results["knob"]
    motions = {law: results[law] for law in LAWS}
    balances = {
        law: energy_balance(found.record.system, scene_named(found, LAWS[law]), motion)
        for law, motion in motions.items()
    }
    shown = {law: motion.instants for law, motion in motions.items()}
    titles = {law: lettered_text(motion.title.rpartition(", ")[2]) for law, motion in motions.items()}
    multipliers = {titles[law]: (shown[law], motion.multipliers["lambda1"]) for law, motion in motions.items()}
    powers = {titles[law]: (shown[law], balance.power) for law, balance in balances.items()}
    return Page(
        {
            "scene": scene_named(found, LAWS["linear"]),
            "values": results["models"]["swinging"].values,
            "until": UNTIL,
            "samples": SAMPLES,
            "spent": {law: float(balance.by_knob[-1]) for law, balance in balances.items()},
            "paper": results["free"],
            "other": results["other"],
            "other_damping": dict(UNDAMPED)["c"],
        },
        figures={
            "knob": draw_curves(
                [
                    Panel(gettext("multiplier λ₁\n(dimensionless)"), multipliers),
                    Panel(gettext("power at the knob\n(dimensionless)"), powers),
                ],
                gettext("t (dimensionless)"),
            )
        },
        sources=(KNOB,),
        files={"knob.js": script(found, results["models"], results["drawing"], results["free"])},
    )


def models(file: Path) -> dict[str, Model]:
    """Return the scenes as models whose parameters are open, by law."""
    found = {}
    for law, scene in LAWS.items():
        given = [name for name in OPEN if name != "omega" or law == "swinging"]
        found[law] = scene_model(file, Request(scene), given, Limits())
    return found


def drawing_of(file: Path, scene: str) -> tuple[tuple[str, ...], Program]:
    """Return the shapes of the system's drawing, and the program of their numbers."""
    drawing = motion_problem(file, Request(scene), Limits()).drawing
    return tuple(map(str, drawing.shapes)), drawing.program


def script(
    found: Derived, models: Mapping[str, Model], drawing: tuple[tuple[str, ...], Program], free: FreeMotion
) -> str:
    """Return the script of the page."""
    shapes, program = drawing
    model = models["linear"]
    data = {
        "coordinates": model.coordinates,
        "until": float(UNTIL),
        "samples": SAMPLES,
        "shapes": shapes,
        "free": free_setting(free, models["exponential"]),
    }
    parts = [
        javascript.write(model.motion, "motion"),
        javascript.write(model.constraints, "constraints"),
        javascript.write(program, "drawing"),
        *(javascript.write(each.law, f"law_{law}") for law, each in models.items()),
        *(javascript.write(singular(found, scene), f"singular_{law}") for law, scene in LAWS.items()),
        f"const LAWS = {{{', '.join(f'{law}: law_{law}' for law in LAWS)}}};",
        f"const SINGULAR = {{{', '.join(f'{law}: singular_{law}' for law in LAWS)}}};",
        f"const DATA = {json.dumps(data)};",
        (TEMPLATES / "knob.js").read_text(encoding="utf-8"),
    ]
    return "\n".join(parts)


def free_setting(free: FreeMotion, model: Model) -> dict[str, Any]:
    """Return the law and the damping for which it is proved that every motion is free, and so without singularities."""
    if free.motion.verdict is not Free.FREE or free.motion.states != "all states":
        raise ValueError("the paper's law does not make every motion free")
    return {"law": "exponential", "c": float(model.values["c"])}


def singular(found: Derived, name: str) -> Program:
    """Real and imaginary part, at the instant a + i b, of what the accelerations are divided by under a law."""
    scene: Scene = scene_named(found, name)
    a, b, t = (Symbol(letter, real=True) for letter in ("a", "b", "t"))
    law = {Symbol(control, real=True): value.subs(t, a + I * b) for control, value in scene.control_law.items()}
    real, imaginary = denominator(found).subs(law).expand(complex=True).as_real_imag()
    parts = {"re": sympy.simplify(real), "im": sympy.simplify(imaginary)}
    inputs = sorted({str(symbol) for part in parts.values() for symbol in part.free_symbols} | {"a", "b"})
    return Program.of_document(
        {
            "format": "holonom-program",
            "version": 1,
            "scene": name,
            "solve": "direct",
            "method": "singular instants",
            "redundant": [],
            "operations": sum(int(part.count_ops()) for part in parts.values()),
            "inputs": inputs,
            "assignments": [[f"w_{part}", from_sympy(value)] for part, value in parts.items()],
            "outputs": {part: f"w_{part}" for part in parts},
        }
    )
