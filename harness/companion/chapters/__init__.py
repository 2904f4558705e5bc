"""The chapters that compute, one a module, named like its page; and the examples that they take their systems from.

Each has `RUNS`, the runs that it needs by name, and a function `page(results)`, which computes from their results what
the page shows beside them, and draws the figures.
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
