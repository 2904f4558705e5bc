"""A system written for the tests, and the pages that `holonom companion` makes of it."""

from click.testing import CliRunner

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

{scene}"""
SMOOTH = """smooth_scene : holonomic_scene(system, title = "Smooth",
  control_law = [u = 1 + t], parameter_values = [k = 2], initial_state = [x = 1, dot(x) = 0])$
"""


def made(tmp_path, scene: str, *others, constrained=True):
    """The command's outcome and the directory of the pages."""
    file, directory = tmp_path / "my system.mac", tmp_path / "pages"
    text = OWN.format(scene=scene)
    file.write_text(text if constrained else text.replace("[y - u*x]", "[]").replace("[u]", "[]"))
    arguments = ["companion", str(file), *map(str, others), "-o", str(directory)]
    return CliRunner(mix_stderr=False).invoke(holonom, arguments, standalone_mode=False), directory
