"""Systems written for the tests, and the pages that `holonom companion` makes of them."""

from collections.abc import Mapping
from pathlib import Path

from click.testing import CliRunner, Result

from holonom.cli import holonom

OWN = """load("holonom.mac")$

system : holonomic_system(
  title          = "Cart & bob on a <stiff> spring",
  coordinates    = [x, y],
  controls       = [u],
  parameters     = [k],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  forces         = [spring = [-k*x, 0]],
  constraints    = [y - u*x])$

"""
SMOOTH = (
    OWN
    + """smooth_scene : holonomic_scene(system, title = "Smooth",
  control_law = [u = 1 + t], parameter_values = [k = 2], initial_state = [x = 1, dot(x) = 0])$
"""
)
ROUGH = (
    OWN.replace("[y - u*x]", "[y - u*x, 2*y - 2*u*x]")
    + """rough_scene : holonomic_scene(system, title = "Rough",
  control_law = [u = 1 + t^(7/2)], parameter_values = [k = 2], initial_state = [x = 1, y = 1, dot(x) = 0, dot(y) = 0])$
"""
)
UNCONSTRAINED = OWN.replace("[y - u*x]", "[]").replace("[u]", "[]")
PLAIN = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2, constraints = [y - u*x])$
rising : holonomic_scene(system, title = "Rising", control_law = [u = 1 + t],
  initial_state = [x = 1, dot(x) = 0], time_span = [0, 1], observe = [residuals])$
endless : holonomic_scene(system, title = "Endless", control_law = [u = 1 + t], initial_state = [x = 1, dot(x) = 0])$
"""
DRAWN = PLAIN.replace("[y - u*x])$", "[y - u*x], drawing = [point([x, y])])$")
RUBBING = "forces = [rubbing = [-abs(lambda1)*signum(dot(x) + 2)/10, 0]]"
BENT = "if t < 1/2 then 1 + t else 1 + t + (t - 1/2)^3"
UNDRAWN = PLAIN.replace("constraints", f"{RUBBING}, constraints").replace("u = 1 + t]", f"u = {BENT}]")
TEXTS = {"my system": SMOOTH, "rough": ROUGH, "unconstrained": UNCONSTRAINED, "drawn": DRAWN, "undrawn": UNDRAWN}


def made(folder: Path, texts: Mapping[str, str], *others: Path, language: str = "en") -> tuple[Result, Path]:
    """The command's outcome and the directory of the pages, of texts by the names of their files and of other files."""
    files = [folder / f"{name}.mac" for name in texts]
    for file, text in zip(files, texts.values(), strict=True):
        file.write_text(text, encoding="utf-8")
    arguments = ["companion", *map(str, (*files, *others)), "-o", str(folder / "pages"), "--language", language]
    return CliRunner(mix_stderr=False).invoke(holonom, arguments, standalone_mode=False), folder / "pages"
