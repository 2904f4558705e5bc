"""The scenes of which wrong records are made: twenty, the first of which have every kind of term, branch and part."""

from pathlib import Path

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"

BRANCHES = """
system : holonomic_system(title = "Roots, logarithms and kinks",
  coordinates = [x, y], controls = [u], parameters = [m, k, c],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, potential_energy = [line = k*log(x^2 + y^2)],
  forces = [friction = [-c*signum(dot(x)) - k*sqrt(x*y), -c*abs(dot(y) - 3)], wind = [c*max(x - 3, 0), k*log(x^2)]],
  constraints = [y - u*x])$
run : holonomic_scene(system, control_law = [u = 2 + t^3], parameter_values = [m = 1, k = 2, c = 1/3],
  initial_state = [x = 2, dot(x) = 1/2], time_span = [0, 1])$
"""
EFFECTS = """
system : holonomic_system(title = "Effects, a redundant constraint, two scenes",
  coordinates = [x, y, z], controls = [u], parameters = [m, k],
  kinetic_energy = [bare = m*(dot(x)^2 + dot(y)^2 + dot(z)^2)/2, turn = x^2*dot(y)^2/2],
  potential_energy = [spring = k*x^2/2, well = k*y*z], forces = [drag = [-dot(x), 0, 0]],
  constraints = [x + y - u, z - x, 2*x + 2*y - 2*u])$
whole : holonomic_scene(system, control_law = [u = 1 + t], parameter_values = [m = 2, k = 3],
  initial_state = [x = 1/2, dot(x) = 1/3])$
part : holonomic_scene(system, effects = [bare, spring], control_law = [u = 1 + t^2], parameter_values = [m = 2, k = 5],
  initial_state = [x = 1/2, dot(x) = 1/3], time_span = [0, 2])$
"""
MICRO = """
system : holonomic_system(title = "A comb in SI units", coordinates = [x, y], controls = [u], parameters = [g],
  kinetic_energy = 1.0e-6*(dot(x)^2 + dot(y)^2)/2,
  potential_energy = [spring = 0.5*2.5e-3*(x - 1.0e-5)^2, gravity = 1.0e-6*g*y],
  forces = [drag = [-3.0e-8*dot(x), -3.0e-8*dot(y)], film = [-1.5e-12*dot(x)*dot(y), 2.0e-11]],
  constraints = [y - 1.2*x - u])$
run : holonomic_scene(system, control_law = [u = 1.0e-5 + 2.0e-5*t], parameter_values = [g = 9.81],
  initial_state = [x = 1.0e-5, dot(x) = 1.0e-4], time_span = [0.1, 0.2])$
"""
POLAR = """
system : holonomic_system(title = "A polar arm", coordinates = [r, phi], controls = [u], parameters = [m, g],
  kinetic_energy = m*(dot(r)^2 + r^2*dot(phi)^2)/2 + u*r*dot(phi), potential_energy = m*g*r*sin(phi),
  constraints = [r - u - cos(phi)/3])$
run : holonomic_scene(system, control_law = [u = 2 + sin(t)], parameter_values = [m = 2, g = 10],
  initial_state = [phi = 0, dot(phi) = 1], time_span = [0, 3])$
"""
HOOK = """
system : holonomic_system(title = "A massless hook", coordinates = [x, z], controls = [u], parameters = [m, k],
  kinetic_energy = m*dot(x)^2/2, potential_energy = k*z^2/2, constraints = [z - x - u^2])$
run : holonomic_scene(system, control_law = [u = 1 + t], parameter_values = [m = 1, k = 2],
  initial_state = [x = 1, dot(x) = 0], time_span = [0, 1])$
"""
CIRCLE = """
system : holonomic_system(title = "A bead on a circle", coordinates = [x, y], controls = [u], parameters = [m, g],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, potential_energy = [gravity = m*g*y],
  forces = [film = [-exp(-x)*dot(x), -tanh(y)*dot(y)]], constraints = [x^2 + y^2 - u^2])$
run : holonomic_scene(system, control_law = [u = 2 + t/5], parameter_values = [m = 1, g = 981/100],
  initial_state = [x = 0.3, dot(x) = 1], initial_guess = [y = -2, dot(y) = 0], time_span = [0, 1])$
"""
LARGE = """
closed_form_size : 60$
system : holonomic_system(title = "Too large", coordinates = [x, y, z], controls = [u], parameters = [m],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2 + 3*dot(z)^2)/2 + x*dot(x)*dot(y), potential_energy = x*y*z,
  constraints = [x + y*z - u, y - x^2])$
run : holonomic_scene(system, control_law = [u = 1 + t], parameter_values = [m = 1],
  initial_state = [x = 1, dot(x) = 1/2], time_span = [0, 1])$
"""
KINKS = """
closed_form_size : 1$
system : holonomic_system(title = "Branches", coordinates = [x, y], controls = [u], parameters = [k],
  kinetic_energy = [bare = (dot(x)^2 + x^2*dot(y)^2)/2], potential_energy = [line = k*log(x^2)],
  forces = [push = [abs(x - 3) + sqrt(x*y), signum(y)*log(x^2)]], constraints = [y - u*x])$
whole : holonomic_scene(system, control_law = [u = 2 + t^3], parameter_values = [k = 2],
  initial_state = [x = 2, dot(x) = 1/2], time_span = [0, 1])$
part : holonomic_scene(system, effects = [bare], parameter_values = [k = 3], initial_state = [x = 2, dot(x) = 1/2])$
"""
TEXTS = (BRANCHES, EFFECTS, MICRO, POLAR, HOOK, CIRCLE, LARGE)

NAMES = (
    *("paper/paper", "paper/knob", "pendulum", "bead", "weightless_cabin", "whirling_bob", "crane", "hoist"),
    *("hard/vanishing_length", "hard/stiff_spring", "hard/repeated_constraint", "linkage", "arm"),
)
FILES = tuple(EXAMPLES / f"{name}.mac" for name in NAMES)


def written(folder):
    """Put the scenes into a folder; their files, the texts first."""
    files = []
    for i, text in enumerate(TEXTS):
        files.append(folder / f"scene{i}.mac")
        files[-1].write_text(f'load("holonom.mac")$\n{text}', encoding="utf-8")
    return (*files, *FILES)
