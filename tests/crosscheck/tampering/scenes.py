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
SWITCHED = """
system : holonomic_system(title = "Switches, a table, an end", coordinates = [x, y], controls = [u, v],
  parameters = [m, c], kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, potential_energy = c*x^2/2,
  forces = [push = [v, -dot(y)]], constraints = [y^2 - u*x])$
run : holonomic_scene(system, control_law = [u = if t < 1 then 2 + t elseif t < 2 then 3 + 2*(t - 1)^2 else 5,
  v = table([[0, 2], [1, 3/2], [2, 2], [3, 1]])], parameter_values = [m = 1, c = 4],
  initial_state = [x = 1, dot(x) = 1/2], initial_guess = [y = 1, dot(y) = 0], time_span = [0, 3],
  until = [y - 4, lambda1], observe = [trajectory, controls])$
"""
SERVO = """
system : holonomic_system(title = "A cart", coordinates = [x, th], controls = [F, w], parameters = [M, g],
  kinetic_energy = M*dot(x)^2/2 + (dot(x)^2 + dot(th)^2 + 2*dot(x)*dot(th)*cos(th))/2,
  potential_energy = g*cos(th) + w*x^2/2, forces = [drive = [F, 0], drag = [-dot(x), 0]])$
run : holonomic_scene(system, servo_constraints = [x = sin(t)], control_law = [w = 1 + t],
  parameter_values = [M = 2, g = 10], initial_state = [th = 1/5, dot(th) = 0], time_span = [0, 1],
  observe = [trajectory, controls])$
"""
PRESCRIBED = """
system : holonomic_system(title = "A bob", coordinates = [r, phi], controls = [u], parameters = [m, g],
  kinetic_energy = m*(dot(r)^2 + r^2*dot(phi)^2)/2, potential_energy = -m*g*r*cos(phi), constraints = [r - u])$
run : holonomic_scene(system, prescribed_reactions = [lambda1 = -3*t], parameter_values = [m = 1, g = 10],
  initial_state = [r = 1, phi = 0, dot(r) = 0, dot(phi) = 2], time_span = [0, 1])$
"""
MOVED = """
system : holonomic_system(title = "A bob on a winch", coordinates = [x, y], controls = [u, w], parameters = [m, g],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, potential_energy = m*g*y, forces = [drag = [-dot(x), 0]],
  constraints = [x^2 + (y - w)^2 - u^2])$
run : holonomic_scene(system, servo_constraints = [y = t - 2], control_law = [w = t^2],
  parameter_values = [m = 1, g = 10],
  initial_state = [x = 3/2, dot(x) = 1], initial_guess = [y = -2, dot(y) = 1, u = 2, dot(u) = 0], time_span = [0, 1],
  observe = [trajectory, controls])$
"""
OTHERS = (
    *((SWITCHED, "t < 2", other) for other in ("t < 9/4", "t < 2 + 1/1000")),
    *((SWITCHED, "[2, 2]", other) for other in ("[2, 2 + 1/10^9]", "[9/4, 2]")),
    *(
        (SWITCHED, "until = [y - 4, lambda1]", f"until = [{other}]")
        for other in ("y - 5, lambda1", "y - 4", "lambda1, y - 4")
    ),
    (SWITCHED, "initial_guess = [y = 1,", "initial_guess = [y = -1,"),
    *((SWITCHED, "x = 1,", f"x = {other},") for other in ("2", "(1 + 1/10^20)")),
    *((SWITCHED, "[0, 3]", other) for other in ("[0, 5/2]", "[1/2, 3]")),
    *((SWITCHED, "c = 4", other) for other in ("c = 4 + 1/10^30", "c = 5")),
    *((SWITCHED, "[trajectory, controls]", other) for other in ("[controls]", "[trajectory, controls, energy]")),
    *((SERVO, "dot(th) = 0", f"dot(th) = {other}") for other in ("1", "1/10^20")),
    *((SERVO, "x = sin(t)", f"x = {other}") for other in ("2*sin(t/2)", "sin(t) + t^5", "sin(t) + 1/7")),
    *((SERVO, old, new) for old, new in (("w = 1 + t", "w = 1 + t^2"), ("[0, 1]", "[0, 2]"), ("-dot(x)", "dot(x)"))),
    *((PRESCRIBED, "-3*t", other) for other in ("-3*t^2", "-3*t + 1/10^20")),
    *((PRESCRIBED, "dot(phi) = 2", f"dot(phi) = {other}") for other in ("-2", "2 + 1/10^20")),
    *((PRESCRIBED, old, new) for old, new in (("r = 1,", "r = 11/10,"), ("m = 1", "m = 2"), ("[0, 1]", "[0, 1/2]"))),
    *((MOVED, "y = t - 2", f"y = {other}") for other in ("2*t - 2", "t - 2 + t^4", "t - 2 + t^2/10^20")),
    *((MOVED, old, new) for old, new in (("w = t^2", "w = t^3"), ("-dot(x)", "dot(x)"), ("u = 2,", "u = -2,"))),
    *((CIRCLE, "y = -2", other) for other in ("y = 2", "y = 1/2")),
)
"""Scenes, and what is written otherwise in others: a record and motions of the latter are wrong ones of the former."""

TEXTS = (BRANCHES, EFFECTS, MICRO, POLAR, HOOK, CIRCLE, LARGE)

NAMES = (
    *("paper/paper", "paper/knob", "pendulum", "bead", "weightless_cabin", "whirling_bob", "crane", "hoist"),
    *("hard/vanishing_length", "hard/stiff_spring", "hard/repeated_constraint", "linkage", "arm"),
)
FILES = tuple(EXAMPLES / f"{name}.mac" for name in NAMES)


def written_texts(folder, texts):
    """Put scenes into a folder; their files."""
    files = []
    for i, text in enumerate(texts):
        files.append(folder / f"scene{i}.mac")
        files[-1].write_text(f'load("holonom.mac")$\n{text}', encoding="utf-8")
    return files


def written(folder):
    """Put the scenes into a folder; their files, the texts first."""
    return (*written_texts(folder, TEXTS), *FILES)
