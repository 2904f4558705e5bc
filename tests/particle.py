"""A small system that several tests describe the same way."""

PARTICLE = """
load("holonom.mac")$

particle : holonomic_system(
  title          = "Particle on a table of controlled height",
  coordinates    = [x, z],
  controls       = [u],
  parameters     = [m, g],
  kinetic_energy = m*(dot(x)^2 + dot(z)^2)/2,
  potential_energy = m*g*z,
  constraints    = [z - u])$

rise : holonomic_scene(particle,
  title            = "The table rises",
  control_law      = [u = t],
  parameter_values = [m = 2, g = 981/100],
  initial_state    = [x = 0, dot(x) = 1/3])$
"""
