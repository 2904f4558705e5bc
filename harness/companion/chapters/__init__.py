"""Chapters with computations, one per module, and the examples that they use.

Each has `RUNS`, its runs by name, and a function `page(results)`, which computes further values and draws the figures.
"""

from ...files import shared

EXAMPLES = shared("examples")
PAPER = EXAMPLES / "paper/paper.mac"
BEAD = EXAMPLES / "bead.mac"
BOB = EXAMPLES / "whirling_bob.mac"
CABIN = EXAMPLES / "weightless_cabin.mac"
KNOB = EXAMPLES / "paper/knob.mac"
LINKAGE = EXAMPLES / "linkage.mac"
PENDULUM = EXAMPLES / "pendulum.mac"
PRESCRIBED_TENSION = EXAMPLES / "prescribed_tension.mac"
SPHERICAL_PENDULUM = EXAMPLES / "spherical_pendulum.mac"

FREE_SCENE = "free_motion_scene"
INITIAL_SCENE = "initial_motion_scene"
BOB_SCENE = "drawn_in_scene"
